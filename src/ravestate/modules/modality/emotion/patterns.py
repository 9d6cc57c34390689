"""Expressions of feelings: patterns over normalised clauses (see `Sentence`).

In a pattern ``~`` matches any number of intensifiers ("so", "really", "a very").
"""

from __future__ import annotations

import re

STRENGTH = (
    "so|such|very|really|truly|quite|pretty|rather|just|simply|always|all|absolutely|most|more|too|also|still|even|"
    "super|real|honestly|actually|do|have|been|is|am|are|the|a|an|my|our|one of|kind of|feeling|already|again|"
    r"(?!family|only|early|ugly|silly|lonely)\w+ly"
)


def _patterns(*lines: str) -> re.Pattern[str]:
    """Return one pattern of several that match whole words."""
    whole = "|".join(line.replace("~", rf"(?:(?:{STRENGTH})\s)*") for line in lines)
    return re.compile(rf"(?<!\w)(?:{whole})(?!\w)")


IMAGINED = re.compile(
    r"\b(?:if|unless|whether|wish|hope|hopes|imagine|suppose|should|would|could|might|may|must|try to|want|wants|have a)\b"
)
"""The beginnings of imagined facts: "if you were clever", "I hope you have a nice day"."""

AFFECTION = _patterns(
    r"(?:i|we) ~(?:love|loved|like|adore|cherish|miss|missed|need|treasure) ~you(?! to\b(?! (?:the moon|bits|death|pieces)))(?! (?:said|say)\b)",
    r"(?:love|miss|missed|missing|adore|loving) you(?! to\b)",
    r"(?:in love with|fallen for|falling for|fond of|crush on|close to|attached to|devoted to|crazy about) you",
    r"care (?:\w+ )?(?:about|for) you",
    r"you mean (?:\w+ ){1,3}to me",
    r"you are ~(?:\w+ ){0,2}(?:friend|buddy|pal|mate|darling|sweetheart|sunshine|treasure|everything|soulmate)",
    r"(?:you|us|we) ~(?:be|are) (?:\w+ ){0,2}friends",
    r"be my (?:\w+ )?(?:friend|buddy|valentine|love)",
    r"(?:hug|hugs|cuddle|cuddles|snuggle|kiss|kisses)(?: \w+){0,4} (?:you|me)",
    r"(?:you|me)(?: \w+){0,3} (?:hug|hugs|cuddle|cuddles|kiss|kisses)",
    r"^(?:big |warm )?(?:hug|hugs|kiss|kisses)(?: and (?:hugs|kisses))?$",
    r"(?:talking|chatting|speaking|being|spending \w+(?: \w+)?|hanging out|playing) (?:to|with) you",
    r"(?:glad|happy|lucky|grateful|thankful|good|nice|great) (?:that )?(?:i|we|to) (?:have|found|met|know|got) you(?! \w+ to\b)",
    r"(?:glad|happy|grateful|thankful) (?:that )?you (?:exist|are here|are (?:with|there for) (?:me|us)|are in my life)",
    r"(?:thinking|thought) of you",
    r"you (?:always )?make me (?:feel )?~(?:happy|loved|safe|warm|at home|better)",
    r"(?:marry|be with|stay with|live with) (?:me|you) ?(?:forever|for ever|always)?",
    r"live without you|life without you",
    r"you complete me|my heart (?:belongs to you|beats for you|is yours)|you (?:have )?(?:stole|stolen|won) my heart",
    r"^(?:(?:hello|hi|hey|good \w+|goodbye|bye|thanks|thank you|oh|yes|no|well|see you|sleep well) )*"
    r"(?:my dear|dear|my love|my darling|darling|sweetheart|sweetie|honey|my friend|my dear friend)(?: robot| friend)?$",
    r"you are ~(?:special|dear|precious|important) to me|you are (?:like )?(?:a|my|the) (?:\w+ ){1,2}to me|(?:in|have) my heart|hold your hand|(?:love|light) of my life|let us (?:hug|cuddle|kiss)",
    r"xoxo|xx|<3",
)

AFFECTION_ASKED = _patterns(
    r"(?:hug|cuddle|kiss) (?:you|me)",
    r"(?:have|get|give \w+) (?:a|another) (?:\w+ )?(?:hug|cuddle|kiss)",
    r"(?:be|become) ~(?:my |best |good |a )*friends?",
    r"(?:be|become) ~(?:my )?(?:valentine|sweetheart)",
    r"marry me",
)
"""Questions that show affection."""

PRAISE = _patterns(
    r"well done|bravo|kudos|hats off|you rock|you rule|you (?:are|were) on fire|nicely done|way to go",
    r"(?:impressed|amazed|fascinated|charmed|blown away) (?:by|with) (?:you|your)",
    r"you (?:\w+ )?(?:impress|amaze|fascinate|inspire|charm)(?:ed)? me",
    r"(?:i|we) ~(?:admire|respect|look up to) (?:you|your)",
    r"(?:i|we) ~(?:like|love|adore|admire|enjoy|enjoyed|appreciate) (?:~your|how you|the way you|what you|it when you)",
    r"(?:it|that|this|you) (?:is|was|are) ~impressive",
    r"proud of you|fan of (?:you|yours)|(?:listen|talk) to you (?:all day|for hours|forever)",
    r"you (?:~know|have taught me|taught me) (?:~much|~a lot|everything|a great deal|(?:~)right thing to \w+|(?:exactly |just )?what to say)",
    r"you (?:always )?(?:make|made) (?:me|us) (?:laugh|smile)|you (?:have )?made my (?:day|week|evening)",
    r"you are (?:one of a kind|one in a million|number one|second to none|on top|the best|the greatest|too much|out of this world)",
    r"(?:no one|nobody|never met \w+|no other \w+|nothing)(?: \w+){0,3} (?:like you|as \w+ as you|\w+er than you)",
    r"(?:never|not) (?:\w+ ){1,4}(?:such a|so) \w+ (?:robot|machine|assistant|listener)",
    r"you (?:have|got) (?:\w+ )?(?:a way with words|good taste|a good heart|a heart of gold|a gift)",
    r"thank you for being (?:~)(?:\w+)",
)
"""Idiomatic compliments; `recogniser.praises` finds the others."""

JOY = _patterns(
    r"yay+|yippee|ya+y|hoo?ray|hurray|hurrah|woo ?hoo+|woo+t|yes yes(?: yes)*|yess+|hallelujah|party time",
    r"(?:i|we)(?: am| are| was| were| feel| felt)? ~(?:happy|glad|delighted|thrilled|excited|overjoyed|ecstatic|cheerful|pleased|"
    r"over the moon|on cloud nine|on top of the world|in (?:a|such a) (?:\w+ )?(?:good|great|wonderful|fantastic) mood|"
    r"great|wonderful|fantastic|amazing|awesome|lucky|blessed|relieved|proud)",
    r"feeling ~(?:happy|great|wonderful|fantastic|amazing|awesome|good)",
    r"(?:good|great|wonderful|fantastic|amazing|best|fabulous|excellent|awesome|happy) news",
    r"(?:i|we|my(?: \w+){1,2}|our(?: \w+){1,2})(?: \w+ly| just| have| has| had| did| also)* (?:won|passed(?! (?:away|on|out|over|by)\b)|graduated|aced|succeeded|"
    r"(?:made|did) it(?! (?:worse|wrong|badly|up|again)\b)|nailed it|"
    r"got (?:~)(?:job|raise|promotion|scholarship|offer|place|puppy|kitten|tickets?|prize|medal|award|visa|degree|licen[cs]e|"
    r"\w+ (?:job|puppy|kitten|mark|marks|grade|grades|prize|result|results|tickets?|house|home|flat|apartment|bike|car|dog)|"
    r"married|engaged|promoted|accepted|hired|a(?= in\b)|in(?= to\b|$))(?! off)|(?:was|were|been|am|are) (?:accepted|promoted|hired|admitted|chosen|selected)|"
    r"found (?:my|our) (?:\w+ )?(?:dog|cat|keys|wallet|ring|love)|fell in love|proposed to me|bought (?:my|our) (?:\w+ )?(?:house|home|flat|apartment|car)|finished (?:my|our) (?:\w+ )?(?:thesis|exam|exams|book|studies))",
    r"(?:baby|son|daughter|child|brother|sister|nephew|niece|grand\w+)(?: \w+)? (?:is|was|has been) born(?! (?:in|on)\b)|"
    r"(?:got|getting|get) (?:married|engaged)|(?:am|is|are) pregnant|having a baby|expecting a baby|(?:becoming|became|become|going to be) (?:a )?(?:grand)?(?:mother|father|parents?|aunt|uncle|dad|mum|mom)",
    r"(?:it is|today is|is) (?:finally )?(?:my birthday|weekend|friday|christmas)|finally (?:weekend|friday|over|done|here|holidays?)",
    r"can not wait|looking forward to|so much fun|(?:had|having) (?:~)(?:fun|blast|great time|good time|lovely time|wonderful time|time of my life)",
    r"could not be (?:more )?(?:happy|happier|better|prouder|more excited)|never (?:been |felt )(?:so |this )?(?:happy|happier|better|good|alive)|no complaints",
    r"best (?:day|night|week|weekend|year|birthday|holiday|vacation|trip|party|gift|present|thing|meal|concert)(?: \w+){0,2}(?: ever| of my life)?",
    r"dreams? (?:came|has come|have come|is coming|comes) true|made my day|lucky me|life is (?:~)(?:good|great|beautiful|wonderful)",
    r"(?:what|such) (?:~)(?:great|lovely|wonderful|beautiful|fantastic|perfect|nice|amazing|gorgeous|good) (?:day|morning|evening|night|weekend|time|party|trip|concert|holiday|feeling|gift|present|game|match)",
    r"what a relief|(?:am|is|are) (?:well|healthy|better|home|safe) again|out of hospital|fully recovered",
    r"jumping for joy|tears of joy|dancing with joy|full of joy|celebrat(?:e|ing)",
)

SORROW = _patterns(
    r"(?:kill|killing|hurt|hurting|harm|cut) myself$|suicidal|suicide|want to die|end my(?: own)? life|(?:was|were) dead|better off dead",
    r"(?:my|our) (?:(?!phone|battery|car|laptop|computer|plants?)\w+ ){1,3}(?:died|is dead|is dying|has died|passed away|was put down)(?: \w+)*",
    r"(?:i|we)(?: am| are| was| feel| felt| have been)? ~(?:sad|depressed|lonely|miserable|heartbroken|unhappy|devastated|hopeless|desperate)",
    r"feeling ~(?:sad|depressed|lonely|miserable|unhappy|hopeless|down)|(?:want|could|have) (?:to )?cry|(?:am|was|been) crying",
    r"lost my (?:\w+ )?(?:mother|father|mum|mom|dad|wife|husband|son|daughter|child|baby|brother|sister|friend|dog|cat|job)",
    r"(?:broke up with|cheated on|left) me$|nobody (?:likes|loves) me|my heart is broken",
    r"(?:i|we) ~(?:hate|despise|detest|loathe) you|(?:fuck|screw) (?:you|off)|piss off|shut up|go to hell|you ~(?:suck|stink)",
    r"(?<!like )(?:you are|you look|you sound) (?:(?!not |never |no )\w+ ){0,4}(?:stupid|dumb|idiots?|morons?|useless|worthless|ugly|pathetic|annoying|"
    r"rubbish|trash|garbage|junk|crap|shit|asshole|bastard|bitch|loser|disgusting|horrible)",
)
"""The user's sorrow, and insults."""

SURPRISE = _patterns(
    r"wo+w+|woa+h+|who+a+|oh my(?: god| gosh| goodness)?|my goodness|goodness(?: me| gracious)?|good (?:heavens|grief|lord)|gosh|gee|blimey|crikey|"
    r"holy (?:cow|moly|smokes?|crap|shit)|for heaven is sake|jeez|yikes|ooh+|oha",
    r"^(?:oh )?(?:no way|really|seriously|for real|what|huh|wait what|no kidding|come on|is it|did you|are you|you did|you do)$",
    r"no way|you do not say|i do not believe (?:it|this|my \w+|what i)|unbelievable|inconceivable|unimaginable|unexpected(?:ly)?",
    r"can not (?:~)believe|hard to believe|could not believe|can hardly believe",
    r"(?:i|we)(?: would| had| have| did| was)? ?(?:not|never)(?: would)?(?: have)? (?:~)(?:expect|expected|expecting|thought|guessed|imagined|dreamed|dreamt|see|seen|heard of|known|knew|know)"
    r"(?: \w+)? ?(?:that|this|it|such|coming|anything like|before|so)?",
    r"who would have (?:thought|guessed|known|expected)|how (?:on earth|in the world|come|can that be|is that possible)|what on earth|what the (?:heck|hell)",
    r"surpris(?:e|ing|ingly)|(?:i|we)(?: am| are| was| were| feel| felt)? ~(?:surprised|shocked|astonished|astounded|amazed|stunned|speechless|baffled|"
    r"flabbergasted|startled|perplexed|taken aback|blown away|at a loss for words|lost for words|gobsmacked|dumbfounded)",
    r"astonishing|astounding|incredible|mind ?blowing|mind blown|bl(?:ew|own) my mind|shocking|jaw ?dropping|extraordinary|remarkable|amazing|stunning",
    r"(?:out of the blue|from nowhere|out of nowhere)|you (?:are|must be|have got to be|got to be) (?:kidding|joking|pulling my leg)(?: me)?|you must be joking|get out of here",
    r"i had no idea|is that (?:~)(?:true|possible|right|real)|that is (?:new to me|news to me|impossible|crazy|insane|wild|nuts|unreal)",
)

SURPRISE_ASKED = _patterns(
    r"^(?:oh |wait )?(?:really|seriously|for real|what|huh|no way|no kidding|is it really|are you sure)$",
    r"are you (?:serious|kidding|joking|for real)(?: me)?|is that (?:~)(?:true|possible|real|so)|how (?:is|can) (?:that|this|it) (?:be )?(?:~)(?:possible|be)?",
    r"how on earth|what on earth|how in the world|what in the world|who would have (?:thought|guessed|known)|what the (?:heck|hell)",
    r"wo+w+|woa+h+|whoa+|oh my (?:god|gosh|goodness)|gosh|unbelievable|can you believe",
)
"""Questions that show surprise."""

DESPITE_NOT = _patterns(
    r"can not (?:~)believe|could not believe|can hardly believe|no way|no kidding|you do not say|i do not believe (?:it|this|my \w+|what i)",
    r"(?:i|we)(?: would| had| have| did| was)? ?(?:not|never) .*(?:expect|thought|guess|imagin|dream|see|heard|know|knew).*",
    r"can not wait|could not be .*|never (?:been|felt) .*|no complaints",
    r"(?:no one|nobody|never met|no other|nothing|never|not) .*(?:like you|as you|than you|robot|machine|assistant|listener)",
    r"without you|no idea|nowhere|second to none|^(?:oh )?no$|is that not .*",
)
"""Expressions in which a negation denies nothing."""
