"""Words with the same meaning in a question: irregular forms, spellings, a few synonyms."""

from __future__ import annotations

_GROUPS = """
become became | begin began begun start | break broke broken | bring brought | build built | buy bought | catch caught
choose chose chosen | die died death | do did done | draw drew drawn | drink drank drunk | drive drove driven | eat ate eaten feed
fall fell fallen | feel felt | fight fought | find found | flee fled | fly flew flown | freeze froze frozen | give gave given
grow grew grown | hold held | keep kept | leave left | lose lost | meet met | rise rose risen | run ran | see saw seen
sell sold | send sent | shine shone | sing sang sung | sink sank sunk | sleep slept | speak spoke spoken | spend spent
stand stood stands | steal stole stolen | swim swam swum | take took taken | teach taught | think thought | throw threw thrown
win won | write wrote written author | lead leads led leader governs | pay money currency | world earth globe | place point spot | lay laid | sea seas ocean | end ended finish last lasted
man men | woman women | person people persons | child children | foot feet | tooth teeth | mouse mice | leaf leaves | wolf wolves
life lives | city cities town | country countries | half halves
big large | bigger larger | biggest largest greatest | small little tiny | smallest littlest tiniest | tall high | tallest highest
fast quick speed | fastest quickest | long length | far distance away | old age | hot temperature cold warm
boil boils boiling | freeze freezes freezing | border borders neighbour neighbor bordering | invent invented inventor patented
discover discovered discoverer | paint painted painter | compose composed composer | found founded founder
colour color | colours colors | centre center | metre meter | metres meters | kilometre kilometer km | kilometres kilometers km
gray grey | labour labor | harbour harbor | neighbour neighbor | organisation organization | defence defense | theatre theater
programme program | litre liter | moon lunar | sun solar | movie film | airplane aeroplane plane | car automobile
ww1 first | ww2 second | usa us america | uk britain kingdom | eu european
form forms formed made
"""


def _read() -> dict[str, tuple[str, ...]]:
    found: dict[str, tuple[str, ...]] = {}
    for group in _GROUPS.replace("\n", "|").split("|"):
        words = group.split()
        for word in words:
            found[word] = tuple(dict.fromkeys((*found.get(word, (word,)), *words)))
    return found


_VARIANTS = _read()


def variants_of(word: str) -> tuple[str, ...]:
    """Return the word itself and its variants.

    Example:
        >>> variants_of("wrote"), variants_of("Peru")
        (('wrote', 'write', 'written', 'author'), ('Peru',))
    """
    return _VARIANTS.get(word.lower(), (word,))
