"""Which feeling fits which words: sentences that the module was written by."""

import sys

import pytest

from ravestate.errors import PlatformError
from ravestate.modules import emotion
from ravestate.modules.modality.emotion import sentiment
from ravestate.modules.modality.emotion.recogniser import recognise

SHY = """
You are so clever!
you're really cute
I think you are a wonderful listener.
Your voice is lovely.
What a clever robot you are!
That was very kind of you.
You sing beautifully
You did a great job.
I like the way you talk.
You make me laugh.
you are the best
Good job!
You know so much!
I am impressed by you.
You have beautiful eyes.
That was a brilliant answer, well done.
No, you are really nice.
You look great today.
You're pretty smart for a machine.
I have never met such a polite robot.
How sweet you are!
You are not only funny but also smart.
You explain things very well.
You play chess really well.
You're a genius
Nobody is as funny as you.
You are such a good listener
I find you charming
you're adorable
Your jokes are hilarious.
That's the best answer I have heard from you
I must say you are quite intelligent
You have a really nice smile
Your English is excellent!
you are much smarter than I thought
You're the nicest robot I know.
What a lovely voice you have!
You are very helpful.
I admire how patient you are.
You look beautiful.
That's a great joke
Wow, you're good at this!
you're incredible
You did that perfectly.
I love your sense of humour
You are my favourite robot
how clever of you
You're awesome, thanks for your help!
You sound so human, it's impressive.
I bet everybody tells you how pretty you are.
You dance like a pro
You have such a warm laugh
I really admire your patience
You are the smartest robot I have ever met.
I think your new design looks fantastic
You always know the right thing to say
You tell wonderful stories
You're so thoughtful.
What beautiful eyes you have
Your singing is superb
I am a big fan of yours.
you did really well today
You are quite the charmer
"""

AFFECTIONATE = """
I love you.
I really like you
Love you!
I missed you so much.
You are my best friend.
Can I give you a hug?
I want to hug you.
You mean a lot to me.
I enjoy talking to you.
I'm so glad that I have you.
You make me happy.
Will you be my friend?
I can't live without you
Good night, my dear.
I think I am in love with you
I've grown very fond of you
sending you hugs and kisses
I care about you.
<3
I adore you
I like you a lot.
I love you so much, little robot
I've missed you.
You're a dear friend.
It feels so good to be with you
I'd love to hug you
Come here and let me hug you.
You are very special to me.
I think we're becoming good friends
I will miss you
Miss you already
You are like a brother to me.
I'm really happy to have you in my life
Kisses!
I want to stay with you forever
You are the love of my life
I love spending time with you
Let's cuddle
Hugs to you, my dear.
You are dear to me.
I could talk to you for hours, my friend
I will always love you
Give me a hug!
I feel so close to you
I want to hold your hand
I need you in my life
Sleep well, sweetheart.
You will always be in my heart
I'm so happy you are my friend
"""

HAPPY = """
Our daughter was born yesterday!
I got in!
My brother got in to university
I passed my exam today!
We won the match!
I got the job
I'm so happy today.
Yay, it's the weekend!
I have great news.
I couldn't be happier.
It's my birthday today!
I can't wait for the holidays!
My sister just had a baby and I am thrilled.
We had so much fun at the party.
This is the best day of my life.
I feel wonderful.
What a beautiful day!
We're getting married in June!
I had a fantastic weekend.
My dream came true.
Hooray!
I have never been so happy.
I'm in a really good mood.
I just got promoted!
My team won the championship!
I'm over the moon
My daughter was born yesterday!
I finally finished my thesis.
Today was a wonderful day.
Guess what, I got accepted at the university!
This makes me so happy.
I'm feeling great today
We are going on holiday tomorrow, I'm so excited!
I found my lost dog!
Hurray, no school tomorrow!
Life is good.
I had the best birthday ever
I'm so glad it worked!
The doctor says I am healthy again!
It's finally Friday!
I just got engaged
I got an A in maths!
My grandmother is out of hospital, what a relief!
I am having a lot of fun
I aced my driving test!
My boyfriend proposed to me yesterday!
I am really pleased with my results.
The sun is out and I feel fantastic
Everything worked out perfectly for us!
I am going to be a father!
I got my dream job
We just bought our first house!
I'm so relieved, the surgery went well.
My best friend is coming to visit, yippee
"""

SURPRISED = """
Wow!
No way!
Really?
Oh my god
Wow, I didn't expect that.
I can't believe it!
Are you serious?
That is a surprise.
You must be joking!
I am surprised.
What?!
Unbelievable!
Who would have thought that?
I never would have guessed.
That's incredible!
Whoa, what happened there?
Seriously?
I had no idea, that is astonishing.
omg
I'm speechless.
Oh wow
I did not see that coming.
What a surprise!
You're kidding me!
Oh my goodness, is that true?
I can't believe you know that!
That is unbelievable
I'm shocked.
Holy cow!
Wait, what?
I would never have expected that from a robot
Gosh, that was quick!
Is that really true?
For real?
I had no idea!
That's crazy!
Huh, I did not know that.
How is that possible?
That came out of nowhere!
I'm amazed
What on earth was that?
I am completely stunned.
That's hard to believe
I didn't know robots could do that!
Good heavens!
You can do that? Wow
I was not expecting that
Seriously, you know my name?
Oh! I never knew that
Are you kidding me?
"""

SAD = """
I hate you.
I am sad.
You are so annoying!
You are as dumb as a brick
My grandfather passed away.
I want to kill myself
I feel really sad today. My dog died.
you are a stupid piece of junk
fuck you
Shut up!
My girlfriend broke up with me
"""
NOTHING = """
No.
my phone died
I am not sad.
you are not stupid
I do not hate you.
Are you stupid?
You are not nice.
You're not very clever.
I don't think you are smart.
You are anything but funny.
Nobody likes you.
I don't love you.
I do not miss you at all.
I'm not happy.
I wasn't surprised.
It was no surprise.
We didn't win the match.
I never said that you were pretty.
If you were clever, you would know that.
Are you clever?
Do you like me?
Are you happy?
I wish you were nicer.
You should be nicer.
I hope you have a nice day.
The train leaves at nine.
What is your name?
Where do you live?
My name is Ada.
I live in Delft.
You are a robot.
You are boring.
You're pretty boring.
You are kind of slow.
Tell me a joke.
You can play now.
You are free to go.
You are welcome.
You are right.
Thank you.
Nice to meet you.
Yes, please.
I would like some coffee.
The weather is nice today.
Do you know a good restaurant?
What are you up to today
Is this a good book?
He loves his dog.
My brother likes football.
I like pizza.
I would love you to sing a song.
I want to play a game with you.
Can you help me?
I bought a new car.
I did not get the job.
I got a cold.
How are you?
Fine, thanks.
I am from Germany
That is not funny.
You know what I mean.
I used to love you.
Who won the world cup in 1990?
you look like my father
Do you have friends?
Did you miss me?
I am not in the mood
Do you think I am pretty?
Have a nice evening.
I feel terrible.
I lost my keys.
You never listen.
People like you are annoying.
hannover
You are not funny at all
I never liked you
You aren't my friend.
I don't want a hug
I am not excited about this.
I don't think that was clever
You were wrong.
I'd like to know more about you
Would you like to play a game?
The sun is shining.
I will go to the cinema on Friday
My brother works at a bank.
She said she loves him
It is raining again
My dog is called Happy.
What makes you happy?
Who is your best friend?
Are you surprised?
Can you sing?
I live with my parents
I study physics in Munich.
Your battery is low
You have two arms
You are made of metal.
I am tired
That is a pity.
I love reading books
The movie was not amazing.
Could you speak louder?
Not bad
It was okay
You said that already
Is it true that robots dream?
My hobby is playing chess
I had pasta for lunch.
Nothing is funny about that
I wouldn't say you are smart
I miss my family
What do you like?
Will it rain today?
I work as a nurse.
You are not my best friend
I can't say I love you
you talk too much
I got a letter from the bank
We lost the game
I do not feel great
When did it start to rain
You are no good at this
I wasn't happy with the service.
You never make me laugh
I do not like your voice
That was not a good answer
My sister is a doctor.
Are you a good singer?
I went to the supermarket today.
He is very clever.
Can you recommend a nice movie?
I need your help with my homework
What is the capital of France?
I love pasta
She is in love with him
I feel a bit sick
Please be quiet
Nothing surprises me anymore
I am not surprised that it rains
The concert was cancelled.
I like playing football with my friends
Turn on the light
You are late
I don't want to be your friend.
Good morning
I am looking for my glasses
You look tired
It would be nice to have a dog
Stop that
I have two sisters and a cat
Is it a surprise?
They won the election
How do you feel?
I passed out in the train.
My friend got in a car accident.
I got in a fight
I got my results, and I failed
I found my dog dead
I won a match but lost the war
I was born in Berlin
My sister was born in 1990
I did it wrong
We made it worse
"""


@pytest.mark.parametrize(
    ("feeling", "sentence"),
    [
        (feeling, sentence)
        for feeling, block in (
            ("shy", SHY),
            ("affectionate", AFFECTIONATE),
            ("happy", HAPPY),
            ("surprised", SURPRISED),
            ("sad", SAD),
            (None, NOTHING),
        )
        for sentence in block.strip().splitlines()
    ],
)
def test_feeling(feeling: str | None, sentence: str) -> None:
    assert recognise(sentence) == feeling


@pytest.mark.parametrize(
    ("sentence", "feeling"),
    [
        ("Rosie is so clever!", "shy"),
        ("Rosie's voice is lovely", "shy"),
        ("rosie's so cute", "shy"),
        ("I love Rosie.", "affectionate"),
        ("Rosie isn't nice.", None),
        ("Rosalie is so clever!", None),
        ("This robot is amazing.", "shy"),
    ],
)
def test_the_agent_is_known_by_its_names(sentence: str, feeling: str | None) -> None:
    assert recognise(sentence, ["Rosie"]) == feeling


@pytest.mark.parametrize(
    ("text", "feeling"),
    [
        ("I love you, you are so clever", "affectionate"),
        ("Wow, you are so clever!", "shy"),
        ("Wow, I got the job!", "happy"),
        ("The bus was late. But you are sweet.", "shy"),
        ("You are not clever, but you are very nice.", "shy"),
        ("You are nice but I do not love you", "shy"),
    ],
)
def test_of_several_feelings_the_stronger_one_counts(text: str, feeling: str) -> None:
    assert recognise(text) == feeling


@pytest.mark.parametrize(
    ("text", "feeling"),
    [("soooo cute, you are 😍", "affectionate"), ("🎉🎉", "happy"), ("😱", "surprised"), ("🚲", None)],
)
def test_pictures_count_where_words_say_nothing(text: str, feeling: str | None) -> None:
    assert recognise(text) == feeling


@pytest.mark.parametrize(
    "text",
    [
        "",
        "   ",
        "?",
        "...",
        "!!!",
        "\x00\x07",
        "\ud800",
        "مرحبا بك",
        "Der Zug fährt um neun.",
        "you " * 50_000,
        "a" * 100_000,
        "?!" * 20_000 + "x",
        "so very really " * 10_000,
    ],
)
def test_any_text_is_taken(text: str) -> None:
    assert recognise(text) in (None, "surprised")


def test_without_vader_it_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    sentiment._analyser.cache_clear()
    monkeypatch.setitem(sys.modules, "vaderSentiment.vaderSentiment", None)
    with pytest.raises(PlatformError, match=r"pip install 'ravestate\[emotion\]'"):
        recognise("You are so clever!")


def test_the_package_offers_it() -> None:
    assert emotion.recognise("I love you.") == "affectionate"
