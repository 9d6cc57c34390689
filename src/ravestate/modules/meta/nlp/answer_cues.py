"""The cues of yes and no: words and phrases without contractions."""

from __future__ import annotations

from enum import Enum

from .pattern import phrases
from .word_set import word_set


class Cue(Enum):
    """The meaning of a cue."""

    YES = "yes"
    YES_WEAK = "weakly yes"
    NO = "no"
    NO_WEAK = "weakly no"
    UNSURE = "does not know"
    HEDGE = "makes weak; alone a weak yes"
    MAYBE = "makes weak; alone does not know"
    SURE = "makes sure; alone a yes"
    NOT = "denies"
    FILLER = "says nothing"

    @property
    def takes_side(self) -> bool:
        """Whether it means yes, no, or unsure."""
        return self in (Cue.YES, Cue.YES_WEAK, Cue.NO, Cue.NO_WEAK, Cue.UNSURE)


_PHRASES: dict[Cue, str] = {
    Cue.YES: """
        (that|this|it|) (would be|will be|sounds|is) (|really|very|so|absolutely|just|quite)
        (good|great|nice|fine|lovely|wonderful|awesome|cool|fantastic|perfect|excellent|brilliant|fun|amazing|ok|okay);
        (that|this|it|what|) (is|sounds like|would be|) (|a|such a) (|very|really) (good|great|nice|wonderful|lovely) (idea|plan);
        great; perfect; awesome; wonderful; excellent; cool; super; fantastic; let us do (it|that|this); let us go; okay then; ok then; that is a yes; quite so; y;
        i would like that (very much|a lot); you can say that again;
        yes; yeah; yep; yup; yea; yah; ya; yay; aye; uh huh; uh-huh; mhm; mm-hmm; mmhmm; affirmative;
        👍; ok; okay; okey; okey-dokey; okey dokey; k; alright; all right; fine; fine by me; fine with me;
        right; correct; exactly; true; agreed; deal; indeed; great idea; good idea; go ahead; go for it;
        please do; yes please; please; sure thing; for sure; why yes; you bet; you got it; hell yes; hell
        yeah; heck yes; heck yeah; oh yes; sounds good; sounds great; sounds fun; sounds nice; sounds like
        fun; sounds like a plan; works for me; count me in; i am in; by all means; of course i do; i agree;
        i do agree; i am sure; i am certain; i am positive; i would like that; i like that idea; i would
        like to; i would love to; i would love that; i want to; i do want to; i would be happy to; i would
        be glad to; i would be delighted; i am happy to; with pleasure; my pleasure; gladly; naturally; no
        problem; no problem at all; no worries; no doubt; no doubt about it; without a doubt; without doubt;
        without question; no objection; no objections; not a problem; i do not mind; i would not mind; i do
        not see why not; i can not complain; i can not say no; not bad; why would i not; who would not; that
        is right; that is true; that is correct; that is it; you are right; that is fine; that is ok; that
        is okay; it is fine; it is ok; that works; i do; i am; i would; i can; i did; i have; i will; i was;
        i could; i should; we do; we are; we can; we did; we have; we will; we would; it is; it does; it
        was; it did; they do; they are; they did; he is; he does; he did; she is; she does; she did; there
        is; there are; that is so; you are; you can; you may; you do; i think yes; always; both
    """,
    Cue.YES_WEAK: """
        i think so; i believe so; i hope so; i guess so; i suppose so; i would think so; i would say so; i
        assume so; i expect so; i imagine so; i reckon so; i should think so; it seems so; seems so; so it
        seems; looks like it; it looks like it; kind of; sort of; a little; a little bit; a bit; somewhat;
        more or less; mostly; sometimes; most of the time; from time to time; now and then; occasionally; usually; partly; in
        a way; to some extent; to a degree; rather yes; more yes than no; if you like; if you want; if you
        want to; if you insist; if you say so; if i must; if you must; if necessary; if possible; why not;
        as far as i know; fair enough; good enough; might as well; i might as well; i could do that; could
        do; i would not say no
    """,
    Cue.NO: """
        (|i am) not (|really|so|very|at all) interested (|in that|at all); (|i am) not in the mood (|for that);
        that is a no; n;
        (i do not want to|i will not) (say|tell|tell you|answer) (|that|this); i do not want to (talk
        about|discuss) (it|that|this); no; nope; nah; nay; naw; nooo; never; never ever; no way; no
        chance; no thanks; no thank you; no never; not at all; not in the least; not in the slightest; not a
        chance; not in a million years; not in my life; by no means; under no circumstances; hell no; heck
        no; god no; of course not; negative; wrong; false; incorrect; uh-uh; nuh-uh; nuh uh; 👎; no sir; not
        anymore; not any more; no longer; no more; not ever; none; neither; not for me; i am afraid not; i
        disagree; i do not agree; i refuse; forget it; forget about it; that is wrong; that is false; that
        is not true; that is not right; that is not correct; that is incorrect; you are wrong; out of the
        question; i do not; i am not; i would not; i can not; i did not; i have not; i will not; i was not;
        i could not; i should not; we do not; we are not; we can not; we did not; it is not; it does not; it
        was not; it did not; they do not; they are not; he is not; he does not; she is not; she does not;
        there is not; you are not; you can not; you may not; i never do; i never did; i never have; i do not
        want to; i do not want that; i do not want it; i do not feel like it; i do not have any; i would
        hate to; i would hate that; i do not like that; i do not like it; i do not like that idea; stop it;
        please do not; do not; thanks but no thanks; none of your business
    """,
    Cue.NO_WEAK: """
        (i do not think|i do not believe|i doubt) (|that) (that|this|it) (is|would be) (|a|such a) (|very|really) (good|great|nice|wonderful|fun) (|idea|plan);
        (i would rather not|rather not|i rather not|i would prefer not to|i prefer not to|better not|i do
        not like to|i would not like to) (say|tell|tell you|answer|do) (|that|this); (i would rather
        not|rather not|i rather not|i would prefer not to|i prefer not to|better not) (talk about|discuss)
        (it|that|this); i do not think so; i do not believe so; i do not think that; i would not say so; i
        would not say that; i do not suppose so; i think not; i guess not; i hope not; i suppose not; i
        doubt it; i doubt that; doubtful; i do not really; i am not really; i have not really; i did not
        really; rather not; i would rather not; i rather not; better not; i would better not; i had better
        not; i prefer not to; i would prefer not to; i would prefer not; i prefer not; hardly; barely;
        scarcely; hardly ever; rarely; seldom; not often; unlikely; not likely; not very likely; most
        unlikely; not yet; not now; not right now; not today; not tonight; not this time; not at the moment;
        another time; some other time; not necessarily; not much; not so much; not very much; not that much;
        not too much; not a lot; not exactly; not quite; not entirely; not completely; not particularly; not
        especially; not always; not so sure about that; not usually; not that i know; not that i know of;
        not as far as i know; not if i can help it; rather no; more no than yes; no comment; i will pass; i
        pass; pass; i have to pass; next question; let us not; i do not feel like that; it does not seem so;
        it does not look like it; not my thing; not my cup of tea; not that often; not really
    """,
    Cue.UNSURE: """
        can not decide; how should i know; how would i know; i am still thinking (|about it);
        (i am not|i am still not|not)
        (really|so|too|very|quite|entirely|completely|absolutely|totally|exactly|that) (sure|certain); i do
        not know; do not know; no idea; i have no idea; i do not have any idea; i have no clue; no clue; i
        have not a clue; not a clue; beats me; i do not have a clue; i am not sure; not sure; i am not so
        sure; not so sure; i am not quite sure; not quite sure; not too sure; i am not too sure; i am not
        entirely sure; i am not completely sure; not entirely sure; not completely sure; i am unsure;
        unsure; i am not certain; not certain; uncertain; i am uncertain; undecided; i am undecided; i am
        torn; hard to say; hard to tell; it is hard to say; it is hard to tell; that is hard to say; that is
        hard to tell; difficult to say; difficult to tell; it is difficult to say; tough to say; tough
        question; difficult question; good question; that is a good question; that is a difficult question;
        it depends; that depends; depends; who knows; god knows; who can say; we will see; let us see; let
        me think; let me think about it; i have to think about it; i need to think about it; i will think
        about it; i need to think; i have to think; i can not say; can not say; i can not tell; can not
        tell; i could not say; i could not tell you; i can not decide; i have not decided; i have not
        decided yet; i can not remember; i do not remember; i forgot; i have never thought about it; i have
        not thought about it; never thought about it; yes and no; neither yes nor no; neither; neither nor;
        fifty fifty; fifty-fifty; could go either way; maybe maybe not; maybe yes maybe no; i wish i knew;
        ask me later; ask me another time; maybe later; perhaps later; maybe another time; perhaps another
        time; maybe some other time; maybe tomorrow; perhaps tomorrow; not certain about that; i do not
        care; i can not answer that; i could not say for sure; i do not know yet; not decided yet; no
        opinion; i have no opinion; search me; it is unclear; unclear; i am in two minds
    """,
    Cue.HEDGE: """
        probably; most probably; very probably; likely; most likely; very likely; quite likely; presumably;
        supposedly; i guess; i suppose; i think; i believe; i assume; i would guess; i would assume; i
        reckon; arguably; in all likelihood; quite possibly; very possibly; apparently; more likely
    """,
    Cue.MAYBE: """
        it is possible; that is possible; possible;
        maybe; perhaps; possibly; might be; could be; may be; it might be; it could be; that might be; that
        could be; that may be; i might; i may; mayhap; potentially; conceivably
    """,
    Cue.SURE: """
        sure; surely; absolutely; definitely; certainly; totally; completely; of course; most certainly;
        most definitely; obviously; clearly; undoubtedly; entirely; positively; very much; very much so; 100
        percent; a hundred percent; one hundred percent; for certain; seriously
    """,
    Cue.NOT: """not""",
    Cue.FILLER: """
        then;
        well; oh; ooh; ah; aah; hm; hmm; hmmm; mm; mmm; um; umm; uhm; uh; er; erm; eh; so; honestly;
        actually; frankly; to be honest; to be frank; to tell you the truth; to tell the truth; if i am
        honest; look; listen; hey; hi; hello; dude; bro; my friend; my dear; sir; god; my god; oh my god;
        gosh; jeez; wow; let me see; thanks; thank you; thank you very much; many thanks; haha; hahaha; lol;
        sorry; i am sorry; excuse me; and; i mean; you know; i would say; in that case; that is; the answer
        is; my answer is; come on; please; anyway; unfortunately; i am afraid; in fact; as a matter of fact;
        hell; heck; damn; too; also; very; at all; i must say; i have to say; i say; in general; generally;
        personally; really; just; simply; quite; wait; ha
    """,
}

CUES: dict[tuple[str, ...], Cue] = {}
"""The cue of each phrase."""
for _cue, _patterns in _PHRASES.items():
    for _phrase in phrases(_patterns):
        CUES.setdefault(_phrase, _cue)

_LIKE_STATEMENTS = word_set(
    "i we it they he she there you that do wrong false true always both neither none please mostly usually",
    "sometimes negative very too also who next pass rarely hardly barely right fine depends look kind sort",
    "somewhat never clearly obviously surely exactly seriously apparently occasionally k could might may quite at",
)

STRICT = frozenset(phrase for phrase in CUES if phrase[0] in _LIKE_STATEMENTS)
"""Phrases that may begin a statement: they answer only before the end, punctuation or another answer."""

UNKNOWNS = word_set("if whether what how where why who when which about on yet exactly because")
"""Words that may follow *I don't know*: *I don't know if I want that*, but not *I don't know my father*."""

STATERS = word_set("i you he she it we they my your his her our their this that these those there the a an")
"""Words that begin a statement after a hedge: *maybe I should go* is not an answer."""

FOLLOWERS = word_set(
    "i you he she it we they my your his her our their this that these those there the a an not because",
    "if when since as to what who where how why do does did can could would will have let for with in at",
    "but although though however sir madam please robot ravestate more everything everyone every some",
    "many most and or maybe me us thank thanks very so only too also tell give go take come call after",
    "before until unless about all of on from especially except",
)
"""Words that may follow an answer without a comma: *no my name is Tom*, but not *no man is an island*."""
