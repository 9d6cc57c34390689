"""Patterns for sentences that state a fact about the user, or take one back."""

from __future__ import annotations

from .patterns import patterns
from .topics import NAME, RELATIVES

ADVERBS = (
    r"((actually|currently|now|still|just|really|also|mostly|originally|mainly|usually|only|sort of|kind of|always|"
    r"already|recently|sometimes|often) )*"
)
AM = rf"(i am|i'm|im) {ADVERBS}"
HAVE = rf"(i have|i've|ive|i) {ADVERBS}"
I = rf"i {ADVERBS}"  # noqa: E741  # it is the word
NOT = rf"{I}(don't|do not|dont) {ADVERBS}"
FREE = r"((in|during) my (free|spare|leisure) time|for fun|as a hobby)"
GROUP = (
    r"([\w-]+ ){0,4}?(club|team|choir|band|orchestra|union|party|association|society|league|group|church|fire brigade|"
    r"fire department|circle)\b.*"
)
STOP = r"(?=$|[,.;!])"

OWN = r"my ((very )?(best|closest|close|good|other|new|older|elder|younger|big|little|twin|only|late|pet) )*"


def _called(nouns: str) -> str:
    """Return patterns for sentences about a relative's name: *my sister is called Emma*."""
    return rf"""
        {OWN}({nouns})s?('s? names?| names?)? (is|are)( called| named)? …
        {OWN}({nouns})'s (called|named) …
        (i have|i've got) (an?|one|two|three|four|some|a few|many) ([\w-]+ )?({nouns})s? (who is |who are |that is )?(called|named) …
        ^(?P<wanted>[\w ,&'-]{{2,60}}?) (is|are) {OWN}({nouns})s?\b
        {OWN}({nouns})s?,? (?P<wanted>[\w'-]+)
    """


def _not_called(nouns: str) -> str:
    return rf"""
        {NOT}have (an? |any |many )?([\w-]+ )?({nouns})s?
        i('ve| have)( got)? no ({nouns})s?
        ^(?P<wanted>[\w ,&'-]{{2,60}}?) (is|are)(n't| not| no longer) {OWN}({nouns})s?\b
        {OWN}({nouns})('s name)? (is|are)(n't| not) (called |named )?(?P<wanted>.+?){STOP}
    """


STATED = patterns(
    {
        NAME: rf"""
            my (full |first |real |own )?name('s| is|s) (actually |really |just )?…
            the name('s| is) …
            (?<!don't )(?<!not )(you (can|may|should|could) |please |just |everybody |everyone |people |they |my friends )calls? me …
            ^(no,? |well,? |hi,? |hello,? )?call me …
            {AM}(called|named) …
            i go by (the name (of )?)?…
        """,
        "home": rf"""
            {I}(live|reside) in (the (city|town|village) of )?…
            {AM}living in (the (city|town|village) of )?…
            my home is (in )?…
            i call (?P<wanted>[^,.]+?) (my )?home
            {HAVE}moved (from \S+ )?to …
        """,
        "origin": rf"""
            {I}(come|came|hail|stem) {ADVERBS}from …
            {AM}from …
            my (home ?town|home country|native (town|city|country)) is …
        """,
        "birthplace": rf"""
            i was {ADVERBS}born (and (raised|brought up) )?in …
            my (birthplace|place of birth) is …
        """,
        "childhood": rf"""
            i ({ADVERBS}grew up|(was (born and )?|have been )(raised|brought up)) in …
        """,
        "age": rf"""
            {AM}(?P<wanted>\d+)( (years?|yrs?)( old| of age)?)?(?= *($|[.,;!]|and\b|but\b|now\b))
            my age is …
        """,
        "hobby": r"""
            my (only |main |biggest |favou?rite |big )?(hobby|hobbies|pastimes?)( is| are|'s|'re) …
            one of my (favou?rite )?(hobbies|pastimes) is …
            ^(?P<wanted>[\w ,'-]{2,60}?) (is|are) (my|one of my) (favou?rite |main )?(hobby|hobbies|pastimes?)\b
        """,
        "hobby:verb": rf"""
            {FREE},? {I}((like|love|enjoy) (to )?)?…
            {I}((like|love|enjoy) (to )?)?(?P<wanted>[\w ,'-]+?) {FREE}
            {I}(?P<wanted>play (?!in\b|at\b|with\b|for\b|along\b|tricks?\b|around\b).+)
            {I}go (?P<wanted>(?!missing|crazy|shopping)\w+ing\b.*)
            {AM}(into|keen on) …
        """,
        "liking:verb": rf"""
            {I}(like|love|enjoy|adore) …
            {AM}(interested in|fond of|crazy about|a (big |huge |great )?(fan|lover) of) …
        """,
        "favourite": r"""
            my (?P<favourite>favou?rite (?!hobb|pastime)[\w-]+( [\w-]+)?) (is|are) …
            ^(?P<wanted>[\w ,'-]{2,60}?) (is|are) my (?P<favourite>favou?rite (?!hobb|pastime)[\w-]+( [\w-]+)?)$
        """,
        "occupation": rf"""
            {HAVE}work(ed|ing)? (full[- ]time |part[- ]time )?as …
            {I}work (for|at|with|in) [\w' -]{{1,40}}? as (?=an? )…
            {AM}(working|employed) (full[- ]time |part[- ]time )?as …
            my (profession|occupation|trade) is (being |to be |that of )?…
            my job is (being |to be |that of )?(?=an? )…
            {AM}(?P<wanted>an? [\w -]+?) by (profession|trade|training)
            i (earn|make) (my|a) (living|money) as …
        """,
        "employer": rf"""
            {I}work ([\w ]{{1,40}}? )?(for|at) …
            {I}work (as [\w ]{{1,40}}? )?in (?=(an?|the|our) (?!field|area|evening|morning|afternoon|city|town|night))…
            {AM}(working|employed) ([\w ]{{1,40}}? )?(for|at|by) …
            my (employer|company|firm) is (called )?…
        """,
        "subject": rf"""
            {I}study …
            {AM}studying …
            my (major|subject|field of study) is …
            i('m| am)? major(ed|ing)? in …
            {AM}(a |an )?student of …
            {AM}doing (a |an |my )?(degree|phd|master'?s?|bachelor'?s?) in …
        """,
        "university": rf"""
            {I}study ([\w ]{{1,40}}? )?at …
            {AM}(studying|enrolled|a student) ([\w ]{{1,40}}? )?at …
            i go to (?P<wanted>([\w-]+ ){{0,4}}(university|college)\b.*)
            my (university|college|uni) is (called )?…
        """,
        **{relative.name: _called(relative.nouns) for relative in RELATIVES},
        "club": rf"""
            {AM}(an? )?(\w+ )?member (of|in) …
            i belong to …
            {HAVE}joined …
            {AM}in (?P<wanted>(an?|the|our) {GROUP})
            {I}(play|sing|dance|train|swim) (\w+ )?(in|with|at) (?P<wanted>(an?|the|our) {GROUP})
        """,
    }
)  # fmt: skip
"""Facts that hold; ``hobby:verb`` marks what one does."""

HAVING = patterns(
    {
        relative.name: rf"(i have|i've got) (an?|one|two|three|four|five|six|seven|\d|some) ([\w-]+ )?({relative.nouns})(?P<several>s|ren)?\b"
        for relative in RELATIVES
    }
)
"""Relatives without their name."""

GONE = patterns(
    {
        "home": rf"""
            {NOT}live (in (?P<wanted>.+?)|there|here)( any ?(more|longer))?{STOP}
            {I}no longer live (in (?P<wanted>.+?)|there|here){STOP}
            {HAVE}moved (away|out)( (from|of) (?P<wanted>.+?))?{STOP}
        """,
        "origin": rf"""
            {AM}not (originally )?from (there|(?P<wanted>.+?)){STOP}
            {NOT}come from (there|(?P<wanted>.+?)){STOP}
        """,
        "birthplace": rf"i was(n't| not) born (there|in (?P<wanted>.+?)){STOP}",
        "childhood": rf"i (didn't|did not) grow up (there|in (?P<wanted>.+?)){STOP}",
        "age": rf"{AM}not (?P<wanted>\d+)( years old)?{STOP}",
        "liking:verb": rf"""
            {NOT}(like|love|enjoy) (?P<wanted>.+?)( any ?more)?{STOP}
            {AM}not (into|keen on|interested in|fond of|a fan of) (?P<wanted>.+?)( any ?more)?{STOP}
        """,
        "hobby:verb": rf"{NOT}(?P<wanted>play .+?|go \w+ing\b.*?)( any ?more)?{STOP}",
        "hobby": r"""
            i (don't|do not|dont) (really )?have (any |a |many )?hobb(y|ies)
            i('ve| have)( got)? no hobb(y|ies)
        """,
        "occupation": rf"""
            i (don't|do not|dont) have a job
            i('ve| have)( got)? no job
            i (don't|do not|dont) work( any ?more)?{STOP}
            {AM}(unemployed|jobless|out of work|between jobs|looking for (a job|work))
            {HAVE}(quit|lost) my job
            {AM}no longer (?P<wanted>an? (?!(\w+ )?member).+?){STOP}
            {AM}not (?P<wanted>an? (?!(\w+ )?member).+?)( any ?more)?{STOP}
        """,
        "employer": rf"""
            {NOT}work (there|(for|at) (?P<wanted>.+?))( any ?(more|longer))?{STOP}
            {I}no longer work (there|(for|at) (?P<wanted>.+?)){STOP}
        """,
        "subject": rf"""
            {NOT}study( any ?(more|thing))?{STOP}
            {I}no longer study
            {HAVE}(stopped|quit|finished) (studying|my studies)
        """,
        **{relative.name: _not_called(relative.nouns) for relative in RELATIVES},
        "club": rf"""
            {AM}not (a |an )?(\w+ )?members? of (any ?thing|any .*)
            {AM}(no longer|not) (a |an )?(\w+ )?member of (?P<wanted>.+?)( any ?more)?{STOP}
            {HAVE}left (?P<wanted>the .+? (club|team|choir|band|party|union))\b
        """,
        NAME: rf"""
            my name('s not| is not| isn't| ain't) (?P<wanted>.+?){STOP}
        """,
    }
)  # fmt: skip
"""Facts that do not hold, or no longer."""
