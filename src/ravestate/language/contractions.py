"""The one table of short forms and slips, and the one table of contractions."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import product


def _table(rows: Mapping[str, str]) -> dict[str, str]:
    """Return a table with one entry for each short form; commas separate those of a row."""
    return {short.strip(): written for shorts, written in rows.items() for short in shorts.split(",")}


WRITTEN: dict[str, str] = _table(
    {
        # Missing apostrophes.
        "im, i´m, iam": "I'm",
        "ive": "I've",
        "youre, youare": "you're",
        "theyre": "they're",
        "youve": "you've",
        "theyve": "they've",
        "weve": "we've",
        "youll": "you'll",
        "theyll": "they'll",
        "itll": "it'll",
        "youd": "you'd",
        "theyd": "they'd",
        "shes": "she's",
        "hes": "he's",
        "whats, wats, whts, wassup, whassup": "what's",
        "sup, wazzup": "what's up",
        "whos": "who's",
        "hows": "how's",
        "wheres": "where's",
        "whens": "when's",
        "whys": "why's",
        "thats, dats, thts": "that's",
        "theres": "there's",
        "heres": "here's",
        "dont, dnt, dont't, do'nt": "don't",
        "doesnt, dosent, doesent, dosnt": "doesn't",
        "didnt, dident, didnot": "didn't",
        "isnt": "isn't",
        "arent": "aren't",
        "wasnt": "wasn't",
        "werent": "weren't",
        "havent": "haven't",
        "hasnt": "hasn't",
        "hadnt": "hadn't",
        "cant, cnt, can't't": "can't",
        "couldnt": "couldn't",
        "wont": "won't",
        "wouldnt": "wouldn't",
        "shouldnt": "shouldn't",
        "mustnt": "mustn't",
        "neednt": "needn't",
        "aint, ain't": "isn't",
        "i aint, i ain't": "I'm not",
        "you aint, you ain't, u aint": "you aren't",
        "we aint, we ain't": "we aren't",
        "they aint, they ain't": "they aren't",
        "lets": "let's",
        "yall, y'all": "you all",
        # Words that sound alike.
        "should of, shoulda": "should have",
        "could of, coulda": "could have",
        "would of, woulda": "would have",
        "must of, musta": "must have",
        "might of": "might have",
        "alot": "a lot",
        "doyou": "do you",
        "areyou": "are you",
        "aswell": "as well",
        "kno, knw, noe": "know",
        "dont no, don't no, dunno no": "don't know",
        "infact": "in fact",
        "no body": "nobody",
        # Short forms.
        "i": "I",
        "u, ya, yu, yuo, yoou": "you",
        "ur, yuor, yoru": "your",
        "urs": "yours",
        "urself": "yourself",
        "r": "are",
        "n, nd": "and",
        "b4": "before",
        "c u, c ya, cu, cya": "see you",
        "l8r": "later",
        "m8": "mate",
        "gr8": "great",
        "h8": "hate",
        "w8": "wait",
        "2moro, 2morrow, tmrw, tmr, tmrow, tomoz": "tomorrow",
        "2day": "today",
        "2nite, tonite, 2night": "tonight",
        "nite": "night",
        "4ever": "forever",
        "sum1, some1": "someone",
        "any1": "anyone",
        "every1": "everyone",
        "no1": "no one",
        "me 2": "me too",
        "wanna": "want to",
        "gonna, gunna": "going to",
        "gotta": "got to",
        "i gotta, ive gotta, i've gotta": "I have to",
        "you gotta, u gotta": "you have to",
        "we gotta": "we have to",
        "they gotta": "they have to",
        "hafta": "have to",
        "gimme": "give me",
        "lemme": "let me",
        "dunno": "don't know",
        "idk": "I don't know",
        "ik": "I know",
        "idc": "I don't care",
        "ily": "I love you",
        "kinda": "kind of",
        "sorta": "sort of",
        "outta": "out of",
        "lotsa": "lots of",
        "cmon, c'mon": "come on",
        "whatcha, watcha": "what are you",
        "wyd": "what are you doing",
        "hru": "how are you",
        "hbu, wbu, wby": "what about you",
        "gtg, g2g": "I have to go",
        "brb": "I'll be right back",
        "ttyl": "talk to you later",
        "gn": "good night",
        "pls, plz, plse": "please",
        "thx, thanx, tnx, thnx": "thanks",
        "ty, tysm, thank u": "thank you",
        "np": "no problem",
        "nvm": "never mind",
        "ofc": "of course",
        "omg": "oh my god",
        "btw": "by the way",
        "tbh": "to be honest",
        "imo": "in my opinion",
        "rn": "right now",
        "bc, cuz, coz, cos, cus, bcoz, 'cause": "because",
        "tho": "though",
        "thru": "through",
        "ppl": "people",
        "abt": "about",
        "smth, sth, sumthing": "something",
        "sry, srry": "sorry",
        "k": "okay",
        "yr": "your",
        "yrs": "years",
        "bday": "birthday",
        "fav, fave": "favourite",
        "luv": "love",
        "wot, waht, wat, wht, whta": "what",
        "teh, da": "the",
        "dis": "this",
        "dat": "that",
        "dey": "they",
        "wiv": "with",
        "jus": "just",
        "liek": "like",
        "goin": "going",
        "doin": "doing",
        "nothin, nuthin": "nothing",
        "somethin": "something",
        "anythin": "anything",
        "everythin": "everything",
        "havin": "having",
        "gettin": "getting",
        "comin": "coming",
        "lookin": "looking",
        "feelin": "feeling",
        "tryin": "trying",
        "workin": "working",
        "talkin": "talking",
        "playin": "playing",
        "livin": "living",
    }
)
"""Short forms and common slips of one or two words, in lower case, as written English has them. There is no second list."""

_AFTER_BE = "a an the so not very too my our really just been going me".split()
for _short, _long in {"its": "it's", "ur": "you're", "your": "you're", "theyre": "they're", "their": "they're"}.items():
    _following = [word for word in _AFTER_BE if _long == "it's" or word not in ("been", "my", "our")]
    WRITTEN.update({f"{_short} {word}": f"{_long} {word}" for word in _following})
WRITTEN["ur welcome"] = WRITTEN["your welcome"] = "you're welcome"
WRITTEN.update({f"id {verb}": f"I'd {verb}" for verb in "like love rather prefer say".split()})
WRITTEN.update({f"ill {verb}": f"I'll {verb}" for verb in "be go have see do try take tell call come get never".split()})
WRITTEN.update({f"2 {word}": f"to {word}" for word in "go be do meet see have eat get play talk know you me the my bed school work town".split()})
WRITTEN.update({"2 u": "to you", "4 u": "for you"} | {f"4 {word}": f"for {word}" for word in "you me my the a".split()})

CONTRACTIONS: dict[str, str] = {
    **{
        f"{subject}'{short}": f"{subject} {verb}"
        for subject, (short, verb) in product(
            ("i", "you", "he", "she", "it", "we", "they", "that", "there", "what", "who", "how", "where", "when", "why", "here"),
            (("m", "am"), ("re", "are"), ("ve", "have"), ("ll", "will"), ("d", "would"), ("s", "is")),
        )
    },
    **{
        f"{verb}n't": f"{verb} not"
        for verb in (
            "do", "does", "did", "is", "are", "was", "were", "have", "has", "had", "could", "would", "should", "must",
            "need", "might",
        )
    },
    "can't": "can not",
    "cannot": "can not",
    "won't": "will not",
    "let's": "let us",
}  # fmt: skip
"""The contractions of written English, in lower case, with their words."""
