"""Words that decide whether a phrase can be a value."""

from __future__ import annotations


def word_set(text: str) -> frozenset[str]:
    """Return the words of a text."""
    return frozenset(text.split())


STATES = word_set(
    """fine good well ok okay great tired sleepy happy sad bored busy hungry thirsty sorry sure ready done back home here
    there not no yes so very too really quite just still also going trying looking feeling afraid alone alright all right cold
    hot warm sick ill healthy free late early new old young big small tall short smart stupid crazy mad angry nervous excited
    glad lonely single married divorced pregnant nice kind bad better worse best awful terrible horrible amazing awesome fantastic
    perfect super cool human alive dead drunk high serious joking kidding curious confused lost stuck right wrong fed up
    impressed surprised disappointed interested shy funny rich poor blind deaf vegan vegetarian gay straight able unable
    allowed supposed about in on at from with like a an the my your his her its our their this that these those it nothing
    nobody noone none anybody someone somebody anything something everything everyone everybody unemployed retired jobless
    self-employed freelance different difficult hard easy important secret private anonymous unknown boring interesting dead
    called named what who why how when where which whatever whoever hello hi hey bye goodbye thanks thank please maybe perhaps
    probably never always nah nope yeah yep yup hmm hm um uh oh ah wow lol haha oops cheers morning evening night later
    tomorrow today yesterday again anyway absolutely certainly definitely exactly correct true false stop wait help quit exit
    me you he she we they us them him i i'm im do does did don't dont go come tell say talk ask let let's lets give show play
    sing stay move forget shut leave doing being having having such bit thing pleasure doubt allergic unsure possible impossible likely most yay sir madam turn ten twenty thirty forty fifty sixty good-bye question welcome nonsense rubbish bullshit fuck shit damn
    """
)
"""First words that no name has: states, and things that people say instead of a name."""

NEVER_IN = word_set(
    """i i'm im you you're youre he she we they it's don't dont doesn't isn't aren't won't can't cannot is are was were do does
    did has have had will would could can might must shall should what why how when who where me us them yourself myself not that's there's what's who's let's let he's she's we're they're want wanna think guess know mean need feel i've i'd i'll you've you'll tell
    """
)
"""Words of sentences that no value has."""

NO_PLACE = word_set(
    """fear peace hope love house flat apartment dorm home nowhere everywhere somewhere here there abroad bed general fact
    january february march april may june july august september october november december summer winter spring autumn
    work school town city village country heaven hell space earth prison trouble love relationship
    """
)

NO_EMPLOYER = word_set(
    """home night nights day days weekends least all it that this myself you me fun money free living hours years weeks months lot while
    minimum remote remotely something someone somebody nothing nobody now work once times
    """
)

NO_SUBJECT = word_set(
    "hard alone here there much lot every every day you people them too now well better more nothing with for at in on this that"
)

NO_HOBBY = word_set(
    """you me it that this these those them him her my your his its our their one two three many few none nothing something anything
    everything everybody everyone all fun nice being having getting more most when if better each"""
)

NOT_DONE = word_set("thing king ring spring string morning evening wedding pudding clothing building ceiling")
"""Words that end like *sailing* without being activities."""

OCCUPATIONS = word_set(
    """accountant actor actress analyst architect artist assistant attorney author baker banker barber barista bartender biologist
    bookseller bricklayer builder butcher carer carpenter cashier chef chemist cleaner clerk coach cobbler composer conductor
    consultant cook counsellor craftsman dancer dentist designer developer director doctor driver economist editor electrician
    engineer farmer firefighter fireman fisherman florist forester gardener geologist geographer goldsmith guard hairdresser
    historian housewife illustrator interpreter janitor jeweller joiner journalist judge lawyer lecturer librarian linguist locksmith
    machinist manager mathematician mechanic midwife miller miner musician nanny nurse optician painter paramedic pensioner pharmacist
    philosopher photographer physician physicist pilot plumber poet policeman policewoman politician porter postman potter priest
    producer professor programmer psychologist psychiatrist pupil receptionist researcher roofer sailor salesman saleswoman scientist
    sculptor secretary seller singer smith sociologist soldier student surgeon surveyor tailor teacher technician therapist trainee
    trainer translator tutor veterinarian vet waiter waitress watchmaker welder writer freelancer entrepreneur officer worker
    administrator astronaut astronomer apprentice
    """
)
"""Nouns that *I am a ...* makes an occupation without being asked."""

VERBS = word_set(
    """read play cook bake dance swim run paint draw sing travel hike climb cycle bike sew knit write collect ski surf fish hunt
    ride watch listen code program game photograph jog train box sail dive camp build make go do juggle meditate blog garden walk
    skate act study learn work tinker craft crochet spend meet hang visit relax sleep eat drink solve take grow keep
    """
)
"""Verbs for activities in one's free time."""

DETERMINERS = word_set("a an the my your his her our their this that it some any")

REMARKS = word_set(
    """no nope nah not never none nothing nobody noone yes yeah thanks thank hello hi hey bye goodbye what why how who lol haha hm hmm
    cool great awesome amazing sorry stop help please maybe perhaps whatever wow oops nonsense next skip pass tell shut go come wait
    interesting raining snowing sunny cloudy windy rainy very too so really nice true false right wrong exactly take see have indeed unfortunately hell whose sort be look can"""
)
"""First words of remarks that are not answers, except in names: *New York*, but *no chance*."""

SMALL = word_set("of the and in on upon am an at der die das den von van de da di del la le du y zu near for bei a")
"""Words without a capital inside a name."""

NO_STUDENT = word_set("good bad new old lazy high-school high school college university uni phd exchange")
"""Words before *student* that are not a subject."""
