"""Turn the raw output of a model into the agent's words while the model writes."""

from __future__ import annotations

import re
import unicodedata

from ravestate.modules._text import without_controls

# Signs that a model continues the conversation by itself, or shows the marks of its template.
_ROLES = ("User", "Human", "Assistant", "System", "Bot", "AI")
_MARKS = r"<\|[^|<>\n]{1,16}\|>|</?s>|\[/?INST\]|<(?:start|end)_of_turn>|^\#{2,4}\s"
# Ends of an unfinished text: a mark that may have begun, or the opening quotation mark of the next sentence.
_BEGUN = re.compile(r"(?:<[|/]?[^|<>\n]{0,16}\|?|\[/?[INST]{0,4}|^\#{1,4}|[\"“‘(\[]+)\Z", re.MULTILINE)
# Signs other than words, such as an emoji, belong to the sentence before them.
_SENTENCE_END = re.compile(r"[.!?…。！？]+[\"”’)\]]*(?:\s+[^\w\s\"“‘(\[]+)*\s+(?=[\"“‘(\[]?\w)")
_ABBREVIATION = re.compile(r"\b(?:Mr|Mrs|Ms|Dr|Prof|St|vs|e\.g|i\.e|etc|[A-Z])\.\s*\Z")
# Emoji, their variants, and their joiners.
_EMOJI = re.compile(
    "[\U0001f000-\U0001faff\u2600-\u27bf\u2b00-\u2bff\u2300-\u23ff\u200d\u20e3\ufe0e\ufe0f\U000e0020-\U000e007f]"
)
_QUOTES = '"“”«»'


class Utterance:
    """A filter for a model's output: it takes pieces, and returns the part to say.

    The filter removes thoughts, the agent's name at the beginning, quotation marks around everything, and control
    characters. It removes emoji, which small models overuse, unless nothing else is left. White space becomes single
    spaces. The utterance is `complete`, and ignores further pieces, after `sentences` sentences, or when the model
    begins to speak for another speaker.

    The filter holds back an end that may become the mark of a speaker or a template. So the result does not depend on the
    size of the pieces.

    Example:
        >>> utterance = Utterance("Rosie")
        >>> [utterance.feed(piece) for piece in ("Rosie: Hel", "lo, ", "who is there? Us", "er: I")]
        ['Hel', 'lo,', ' who is there?', '']
        >>> utterance.complete, utterance.text
        (True, 'Hello, who is there?')
    """

    def __init__(self, name: str = "Ravestate", *, sentences: int = 2) -> None:
        """`name`: the agent's name; `sentences`: the maximum number of sentences, at least 1."""
        if sentences < 1:
            raise ValueError(f"sentences must be at least 1, not {sentences}")
        self._names = tuple(f"{n}:" for n in (name, *_ROLES) if n)
        names = "|".join(re.escape(n) for n in self._names)
        own = "|".join(re.escape(n) for n in (name, "Assistant", "AI", "Bot") if n)
        self._front = re.compile(rf"[\s{_QUOTES}]*(?:(?:{own}):[\s{_QUOTES}]*)?")
        self._mark = re.compile(rf"(?:^|(?<=\s))(?:{names})|{_MARKS}", re.MULTILINE)
        self._sentences = sentences
        self._written = ""
        self._said = ""
        self._emoji = ""
        self.complete = False

    @property
    def text(self) -> str:
        """The words so far."""
        return self._said

    def feed(self, piece: str) -> str:
        """Take the next piece, and return the words to say now."""
        if self.complete:
            return ""
        piece = without_controls(piece)
        if not self._emoji and (found := _EMOJI.search(piece)) is not None:
            self._emoji = found[0]
        self._written += _EMOJI.sub("", piece)
        return self._say(last=False)

    def finish(self) -> str:
        """End the output, and return the words that were held back."""
        rest = "" if self.complete else self._say(last=True)
        if not self.worth_saying() and self._emoji:
            rest = self._said = self._emoji
        self.complete = True
        return rest

    def worth_saying(self) -> bool:
        """Return whether the utterance has more than punctuation."""
        return any(unicodedata.category(character)[0] not in "PZC" for character in self._said)

    # ------------------------------------------------------------------------------- internals

    def _say(self, *, last: bool) -> str:
        text = self._written
        # Further pieces cannot change the meaning of the text before position `sure`.
        sure = len(text) if last else self._sure(text)
        start = self._past_thoughts(text)
        if start > sure:
            return ""
        front = self._front.match(text, start)  # the match may still grow, but then `sure` is before it
        assert front is not None  # it matches the empty string
        start, quoted = front.end(), any(mark in front[0] for mark in _QUOTES)
        cut = self._cut(text, start)
        if cut is not None and cut <= sure:
            self.complete = last = True
            sure = cut
        said = " ".join(text[start : max(start, sure)].split())
        if not last:
            # White space and closing quotation marks wait for the text after them.
            said = said.rstrip(_QUOTES + " ")
        elif quoted:
            said = said.rstrip(_QUOTES + " ")
        more, self._said = said[len(self._said) :], said
        return more

    def _sure(self, text: str) -> int:
        begun = _BEGUN.search(text)
        sure = len(text) if begun is None else begun.start()
        for name in self._names:
            for length in range(1, len(name)):
                start = len(text) - length
                if text.endswith(name[:length]) and not text[:start][-1:].isalnum():
                    sure = min(sure, start)
        return sure

    def _past_thoughts(self, text: str) -> int:
        """Return the position where the answer begins, after the thoughts of a reasoning model."""
        start = len(text) - len(text.lstrip())
        if not text.startswith("<think>", start):
            return start
        end = text.find("</think>", start)
        return len(text) + 1 if end < 0 else end + len("</think>")

    def _cut(self, text: str, start: int) -> int | None:
        mark = self._mark.search(text, start)
        end = len(text) if mark is None else mark.start()
        left = self._sentences
        for sentence in _SENTENCE_END.finditer(text, start, end):
            after = sentence.end()
            if _ABBREVIATION.search(text[start:after]) or text[after].islower():
                continue
            left -= 1
            if not left:
                return after
        return None if mark is None else end
