"""Raveboard in a real browser: the timeline, why-not, the clock, input on the board, recordings and accessibility."""

import asyncio
import base64
import contextlib
import gzip
import json
import os
import re
import struct
from collections.abc import AsyncGenerator
from pathlib import Path
from typing import Any

import pytest
from playwright.async_api import Locator, Page, expect

import ravestate as rs
from end_to_end.stage import PHONE, Host, Stage, on_stage
from end_to_end.test_access import findings
from ravestate.board.application import INSIDE, PAGE, RecordedAgent, routes
from ravestate.modules import rawio, webio
from ravestate.modules.platform.webio.server import Server
from ravestate.modules.platform.webio.session import Ending

SCRIPT = 300_000
"""The maximum size of all scripts of the page, compressed (bytes)."""

keeper = rs.Module("keeper", requires=(rawio,))
question = keeper.signal("question", payload=str)
notebook: rs.Slot[Any] = keeper.slot("notebook", None)
rung = keeper.signal("rung")


class Cue:
    """An event for which the classifier waits. The test sets it."""

    classified = asyncio.Event()


@keeper.rule(when=rawio.input.changed, emits=question)
async def classify(ctx: rs.RuleContext) -> None:
    """Classify an input as a question or something else."""
    await Cue.classified.wait()
    if "?" in ctx.payload(rawio.input.changed):
        ctx.emit(question, ctx.payload(rawio.input.changed))


@keeper.rule(when=question, writes=rawio.output)
async def answer(ctx: rs.RuleContext) -> rs.Resign | None:
    """Answer a question."""
    if "why" in ctx.payload(question):
        return rs.Resign("nobody knows why")
    ctx[rawio.output] = "Since 1665."
    return None


@keeper.rule(when=rawio.input.changed, writes=rawio.output)
async def small_talk(ctx: rs.RuleContext) -> None:
    """Answer when no other rule does."""
    ctx[rawio.output] = "I see."


@keeper.rule(when=rung.min_age(60.0).max_age(None), writes=notebook)
async def note(ctx: rs.RuleContext) -> None:
    """Write a note 60 s after the signal `rung`."""
    ctx[notebook] = "it rang"


@contextlib.asynccontextmanager
async def served(*modules: rs.Module, **settings: Any) -> AsyncGenerator[Host]:
    """Serve an agent with its board. Without modules, the agent is `keeper`."""
    Cue.classified = asyncio.Event()
    Cue.classified.set()
    options = {"webio": {"port": 0, "title": "Elske", **settings}}
    agent = RecordedAgent(*(modules or (keeper,)), webio, settings=options)
    async with Server(agent, routes(agent.recorders, title="Elske"), INSIDE) as server:
        yield Host(server)


async def say(page: Page, text: str) -> None:
    """Say something on the board."""
    await page.get_by_role("tab", name="Slots").click()
    await page.get_by_label("Say something to the agent").fill(text)
    await page.get_by_label("Say something to the agent").press("Enter")


def name(page: Page, rule: str) -> Locator:
    """Return the button with the name of a rule, beside its lane."""
    return page.locator(f'button.lane[title="{rule}"]')


def node(page: Page, id: str) -> Locator:
    """Return the node of the diagram with an id."""
    return page.locator(f'[data-id="{id}"]')


async def lane(page: Page, rule: str) -> list[dict[str, Any]]:
    """Return the bars in the lane of a rule."""
    return await page.evaluate(
        """rule => (window.raveboard.trace.lanes.get(rule)?.bars ?? []).map(bar => ({
            outcome: bar.outcome, states: bar.phases.map(phase => phase.state),
            waits: bar.phases.flatMap(phase => phase.waits ?? []), ended: bar.to !== null,
        }))""",
        rule,
    )


async def until_lane(page: Page, rule: str, outcome: str) -> list[dict[str, Any]]:
    """Wait until the last bar in the lane of a rule has this outcome; return the bars."""
    await page.wait_for_function(
        "([rule, outcome]) => window.raveboard.trace.lanes.get(rule)?.bars.at(-1)?.outcome === outcome",
        arg=[rule, outcome],
    )
    return await lane(page, rule)


async def painted(page: Page, rule: str) -> set[str]:
    """Return the states whose colours the lane of a rule shows."""
    return set(
        await page.evaluate(
            """rule => {
                const names = [...document.querySelectorAll("button.lane")].map(b => b.title);
                const top = (names.indexOf(rule) + 1) * 26 + 26;
                const canvas = document.querySelector("canvas.main");
                const ratio = canvas.width / canvas.clientWidth;
                const data = canvas.getContext("2d").getImageData(0, top * ratio, canvas.width, 26 * ratio).data;
                const style = getComputedStyle(document.documentElement);
                const seen = new Set();
                for (let i = 0; i < data.length; i += 4) seen.add([data[i], data[i + 1], data[i + 2]].join());
                const rgb = hex => [1, 3, 5].map(at => parseInt(hex.slice(at, at + 2), 16)).join();
                return ["waiting", "running", "done", "interrupted", "resigned", "failed"].filter(
                    state => seen.has(rgb(style.getPropertyValue(`--${state}-light`).trim())));
            }""",
            rule,
        )
    )


async def passing(page: Page, seconds: float) -> None:
    """Wait until the agent's clock on the page has advanced by some seconds."""
    await page.evaluate(
        """seconds => new Promise(resolve => {
            const until = window.raveboard.now() + seconds;
            const look = () => window.raveboard.now() >= until ? resolve() : requestAnimationFrame(look);
            look();
        })""",
        seconds,
    )


async def drawn(page: Page) -> None:
    """Wait until the page has painted."""
    await page.evaluate("() => new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")


async def step_until(page: Page, condition: str) -> None:
    """Press "Step" until a JavaScript condition is true in the page."""
    for _ in range(100):
        await page.get_by_role("button", name="Step").click()
        await drawn(page)
        if await page.evaluate(condition):
            return
    raise AssertionError(f"still false after a hundred steps: {condition}")


@on_stage
async def test_the_timeline_shows_the_rule_that_won_and_the_rule_that_waited(stage: Stage) -> None:
    async with served() as host, stage.open(f"{host.address}board/", color_scheme="light") as page:
        await expect(page.locator(".status")).to_have_text("live")
        Cue.classified.clear()
        await say(page, "Since when?")
        await page.wait_for_function(
            "() => window.raveboard.trace.lanes.get('keeper:small_talk')?.bars[0]?.phases.at(-1)?.state === 'waiting'"
        )
        await passing(page, 0.4)  # long enough for a bar that can be seen
        assert "waiting" in await painted(page, "keeper:small_talk")
        assert "running" in await painted(page, "keeper:classify")
        Cue.classified.set()
        (won,) = await until_lane(page, "keeper:answer", "done")
        (lost,) = await until_lane(page, "keeper:small_talk", "consumed")
        assert won["states"][-1] == "running"
        assert (lost["states"][-1], lost["waits"]) == ("waiting", ["keeper:answer"])
        await page.get_by_role("button", name="All", exact=True).click()
        await drawn(page)
        assert "done" in await painted(page, "keeper:answer")
        assert "waiting" in await painted(page, "keeper:small_talk")


@on_stage
async def test_why_not_is_answered_with_the_right_reason(stage: Stage) -> None:
    async with served() as host, stage.open(f"{host.address}board/") as page:
        await say(page, "Since when?")
        await until_lane(page, "keeper:answer", "done")
        await name(page, "keeper:small_talk").click()
        answered = page.locator(".answer")
        await expect(answered).to_have_attribute("data-verdict", "outrun")
        found = host.sessions[0].context.explain
        ahead = found("keeper:answer").clauses[0].utility - found("keeper:small_talk").clauses[0].utility
        await expect(answered).to_contain_text(f"keeper:answer ({ahead:.3f} nats ahead)")
        await answered.get_by_role("button", name="keeper:answer").first.click()
        await expect(answered).to_have_attribute("data-verdict", "fired")
        await say(page, "but why?")
        await until_lane(page, "keeper:answer", "resigned")
        await name(page, "keeper:answer").click()
        await page.get_by_role("tab", name="Rule").click()
        option = await page.locator("#cause option").first.get_attribute("value")
        await page.locator("#cause").select_option(option)
        await expect(answered).to_contain_text("resigned: nobody knows why")
        await say(page, "Nice.")
        await until_lane(page, "keeper:small_talk", "done")
        await page.get_by_role("tab", name="Rule").click()
        await page.wait_for_function("old => document.querySelector('#cause option')?.value !== old", arg=option)
        await page.locator("#cause").select_option(index=0)
        await expect(answered).to_contain_text("keeper:classify finished without raising it")


@on_stage
async def test_the_rule_panel_shows_the_parts_of_the_utility(stage: Stage) -> None:
    async with served() as host, stage.open(f"{host.address}board/") as page:
        await name(page, "keeper:answer").click()
        table = page.locator(".clause table")
        terms = await table.locator("tbody tr").all_inner_texts()
        total = float(await table.locator("tfoot td").last.inner_text())
        assert len(terms) == 2
        assert sum(float(term.split("\t")[-1]) for term in terms) == pytest.approx(total, abs=0.002)


@on_stage
async def test_pause_step_and_continue_act_on_the_clock_and_not_on_the_view(stage: Stage) -> None:
    async with served() as host, stage.open(f"{host.address}board/") as page:
        await page.get_by_role("button", name="Pause", exact=True).click()
        await expect(page.locator(".status")).to_have_text("paused")
        before = await page.evaluate("window.raveboard.now()")
        await say(page, "Hello.")
        await page.wait_for_function("() => window.raveboard.trace.occurred.has('rawio:input:changed')")
        assert await lane(page, "keeper:classify") != []
        assert not any(bar["ended"] for bar in await lane(page, "keeper:classify"))
        assert await page.evaluate("window.raveboard.now()") == before
        await step_until(page, "window.raveboard.trace.lanes.get('keeper:small_talk')?.bars.at(-1)?.outcome === 'done'")
        assert await page.evaluate("window.raveboard.paused")
        await page.get_by_role("button", name="Continue").click()
        await expect(page.locator(".status")).to_have_text("live")
        await page.get_by_role("button", name="Following").click()
        left = await page.evaluate("window.raveboard.view.left")
        await passing(page, 0.3)
        assert await page.evaluate("window.raveboard.view.left") == left
        assert not await page.evaluate("window.raveboard.paused")


@on_stage
async def test_a_step_moves_the_clock_to_the_next_deadline(stage: Stage) -> None:
    async with served() as host, stage.open(f"{host.address}board/") as page:
        await page.get_by_role("tab", name="Signals").click()
        await page.get_by_role("button", name="Emit keeper:rung").click()
        await page.get_by_role("button", name="Emit", exact=True).click()
        await page.wait_for_function("() => window.raveboard.trace.occurred.has('keeper:rung')")
        await page.get_by_role("button", name="Pause", exact=True).click()
        await expect(page.locator(".status")).to_have_text("paused")
        await step_until(page, "window.raveboard.now() > 60")
        await until_lane(page, "keeper:note", "done")


@on_stage
async def test_the_board_writes_slots_and_shows_markup_in_them_as_text(stage: Stage) -> None:
    async with served() as host, stage.open(f"{host.address}board/") as page:
        await page.get_by_role("tab", name="Slots").click()
        await page.get_by_role("button", name="Edit keeper:notebook").click()
        markup = "<img src=x onerror=\"document.title='run'\">"
        await page.get_by_label("New value of keeper:notebook").fill(markup)
        await page.get_by_role("button", name="Write").click()
        await expect(page.get_by_text(json.dumps(markup))).to_be_visible()
        assert await page.title() == "Elske – Raveboard"
        (session,) = host.sessions
        assert session.context.read(notebook) == markup
        await page.get_by_role("button", name="Edit rawio:input").click()
        await page.get_by_label("New value of rawio:input").fill("7")
        await page.get_by_role("button", name="Write").click()
        await expect(page.get_by_role("alert")).to_contain_text("which takes str, not int")


@on_stage
async def test_the_chat_page_leads_to_the_board_of_its_own_conversation(stage: Stage) -> None:
    async with served() as host, stage.open(host.address) as page, stage.open(host.address) as other:
        await expect(page.get_by_role("link", name="Look inside")).to_be_visible()
        await page.get_by_label("What you say to Elske").fill("It is quiet here.")
        await page.get_by_label("What you say to Elske").press("Enter")
        await expect(other.get_by_role("link", name="Look inside")).to_be_visible()
        async with page.context.expect_page() as opening:
            await page.get_by_role("link", name="Look inside").click()
        board = await opening.value
        await board.wait_for_function("() => window.raveboard?.trace.slots.has('rawio:input')")
        await board.wait_for_function(
            "() => window.raveboard.trace.slots.get('rawio:input').shown.text === '\"It is quiet here.\"'"
        )
        assert "session" not in board.url
        await board.reload()
        await board.wait_for_function(
            "() => window.raveboard?.trace.slots.get('rawio:input')?.shown.text === '\"It is quiet here.\"'"
        )


@on_stage
async def test_the_board_asks_for_the_token(stage: Stage) -> None:
    async with served(token="open-sesame-please") as host:
        async with stage.open(f"{host.address}board/") as page:
            await page.get_by_label("This board needs a token.").fill("open-sesame-please")
            await page.get_by_role("button", name="Open", exact=True).click()
            await expect(page.locator(".status")).to_have_text("live")
        async with stage.open(f"{host.address}board/#token=open-sesame-please") as page:
            await expect(page.locator(".status")).to_have_text("live")
            assert "token" not in page.url


@on_stage
async def test_an_exported_trace_can_be_opened_as_a_recording(stage: Stage, tmp_path: Path) -> None:
    async with served() as host, stage.open(f"{host.address}board/", complaints=True) as page:
        await say(page, "Since when?")
        await until_lane(page, "keeper:answer", "done")
        async with page.expect_download() as downloading:
            await page.get_by_role("button", name="Export").click()
        file = tmp_path / "trace.json"
        download = await downloading.value
        assert re.fullmatch(r"elske-.+-\d{4}-\d\d-\d\dt\d\d-\d\d-trace\.json", download.suggested_filename)
        await download.save_as(file)
        await page.get_by_label("Open a recorded trace").set_input_files(file)
        await expect(page.locator(".status")).to_have_text("recording")
        await name(page, "keeper:small_talk").click()
        await expect(page.locator(".answer")).to_have_attribute("data-verdict", "outrun")
        await expect(page.get_by_text("trace.json")).to_be_visible()
        (tmp_path / "bad.json").write_text("{}", "utf-8")
        await page.get_by_label("Open a recorded trace").set_input_files(tmp_path / "bad.json")
        await expect(page.get_by_role("alert")).to_contain_text("bad.json: this is not a trace")
        await page.get_by_role("button", name="Close this recording").click()
        await expect(page.locator(".status")).to_have_text("live")
        await expect(page.get_by_text("trace.json")).to_have_count(0)
        await say(page, "Hello again.")
        await until_lane(page, "keeper:small_talk", "done")


@on_stage
async def test_after_a_lost_connection_the_board_shows_the_history_again(stage: Stage) -> None:
    async with served() as host, stage.open(f"{host.address}board/", complaints=True) as page:
        await say(page, "Since when?")
        await until_lane(page, "keeper:answer", "done")
        with host.away():
            await expect(page.get_by_text("The agent does not respond")).to_be_visible()
        await expect(page.locator(".status")).to_have_text("live")
        assert [bar["outcome"] for bar in await until_lane(page, "keeper:answer", "done")] == ["done"]


@on_stage
async def test_the_diagram_folds_modules_and_shows_running_and_waiting_rules(stage: Stage) -> None:
    async with served() as host, stage.open(f"{host.address}board/") as page:
        await page.get_by_role("button", name="Diagram").click()
        await expect(node(page, "rule keeper:answer")).to_be_visible()
        Cue.classified.clear()
        await say(page, "Since when?")
        await expect(node(page, "rule keeper:classify")).to_have_attribute("data-state", "running")
        await expect(node(page, "rule keeper:small_talk")).to_have_attribute("data-state", "waiting")
        Cue.classified.set()
        await page.get_by_role("button", name="Fold all", exact=True).click()
        await node(page, "module keeper").press("Enter")
        await node(page, "rule keeper:answer").press("Enter")
        await expect(page.get_by_role("heading", name="keeper:answer")).to_be_visible()


def skill(number: int) -> rs.Module:
    """Return one of many modules. Its four rules react to inputs with its number."""
    module = rs.Module(f"skill_{number}", requires=(rawio,))
    topic, asked, memory = module.signal("topic"), module.signal("asked"), module.slot("memory", 0)
    heard = rawio.input.changed.where(lambda text: str(number) in text)

    @module.rule(when=heard, emits=topic)
    async def notice(ctx: rs.RuleContext) -> None:
        ctx.emit(topic)

    @module.rule(when=topic & rawio.input.changed, emits=asked)
    async def classify(ctx: rs.RuleContext) -> None:
        ctx.emit(asked)

    @module.rule(when=asked, reads=memory, writes=rawio.output)
    async def answer(ctx: rs.RuleContext) -> None:
        ctx[rawio.output] = f"{number}!"

    @module.rule(when=topic, writes=memory)
    async def remember(ctx: rs.RuleContext) -> None:
        ctx[memory] = number

    return module


@on_stage
async def test_a_policy_of_more_than_a_hundred_rules_can_be_filtered_and_unfolded(stage: Stage) -> None:
    skills = [skill(number) for number in range(30)]
    async with (
        served(*skills) as host,
        stage.open(f"{host.address}board/", viewport={"width": 1280, "height": 720}) as page,
    ):
        lanes = page.locator('button.lane[title*=":"]')
        await say(page, "7")
        await until_lane(page, "skill_7:answer", "done")
        assert 4 <= await lanes.count() < 50  # only the rules that reacted have a lane
        await page.get_by_role("button", name="idle rules").click()
        await expect(lanes).to_have_count(130)
        await page.get_by_label("Filter rules").fill("skill_12 output")
        await expect(lanes).to_have_count(1)
        await page.get_by_role("button", name="Diagram").click()
        await expect(page.locator(".node.module")).to_have_count(34)
        await expect(page.locator(".node:not(.faint)")).to_have_count(1)
        await page.get_by_role("button", name="Unfold all").click()
        await expect(page.locator(".node.rule")).to_have_count(130)
        await expect(page.locator(".node.rule:not(.faint)")).to_have_count(1)
        await page.get_by_label("Filter rules").fill("")
        await expect(page.locator(".node.faint")).to_have_count(0)
        boxes = await page.evaluate("window.raveboard.diagram.nodes.map(({ box }) => box)")
        assert not any(
            ax < bx + bw and bx < ax + aw and ay < by + bh and by < ay + ah
            for number, (ax, ay, aw, ah) in enumerate(boxes)
            for bx, by, bw, bh in boxes[:number]
        )
        await page.get_by_role("tab", name="Rule").click()
        await page.get_by_role("button", name="remember", exact=True).nth(3).click()
        chosen = page.locator(".node.chosen")
        await expect(chosen).to_be_in_viewport()
        shown = await chosen.bounding_box()
        assert shown is not None
        assert shown["height"] > 20  # pixels: enough for two lines of text
        joined = page.locator(".node:not(.faint)")
        await expect(joined).to_have_count(3)  # the rule, its signal and its slot


@on_stage
async def test_the_result_of_the_newest_input_links_to_its_rules(stage: Stage) -> None:
    async with served() as host, stage.open(f"{host.address}board/") as page:
        await say(page, "Since when?")
        await until_lane(page, "keeper:answer", "done")
        await page.get_by_role("tab", name="Rule").click()
        lost = page.get_by_role("button", name="keeper:small_talk gave up: keeper:classify → keeper:answer answered")
        await lost.click()
        await expect(page.locator(".answer")).to_have_attribute("data-verdict", "outrun")
        await page.get_by_role("button", name="Close this rule").click()
        await expect(lost).to_be_visible()


@on_stage
async def test_choosing_a_cause_shows_the_time_from_the_cause_to_its_answer(stage: Stage) -> None:
    async with served() as host, stage.open(f"{host.address}board/") as page:
        await say(page, "Since when?")
        await until_lane(page, "keeper:answer", "done")
        await page.get_by_role("tab", name="Rule").click()
        causes = page.get_by_label("Cause", exact=True)
        value = await causes.locator("option", has_text='"Since when?"').get_attribute("value")
        await causes.select_option(value)
        await expect(page.get_by_role("button", name="Follow", exact=True)).to_be_visible()
        seen = await page.evaluate("[window.raveboard.view.left, window.raveboard.view.right]")
        asked, answered = await page.evaluate(
            "[window.raveboard.cause.time, window.raveboard.trace.lanes.get('keeper:answer').bars.at(-1).to]"
        )
        assert seen[0] < asked <= answered < seen[1] < asked + 2
        await page.get_by_role("button", name="Newest").click()
        await expect(page.get_by_role("button", name="Following")).to_be_visible()


@on_stage
async def test_after_the_end_of_a_conversation_the_board_refuses_input_and_says_why(stage: Stage) -> None:
    async with served() as host, stage.open(f"{host.address}board/") as page:
        await page.get_by_role("tab", name="Slots").click()
        await expect(page.get_by_role("button", name="Edit keeper:notebook")).to_be_visible()
        (session,) = host.sessions
        host.app.state.sessions.leave(session, Ending.BYE)
        await expect(page.get_by_text("This conversation has ended: the visitor left.")).to_be_visible()
        await expect(page.get_by_role("button", name="Say", exact=True)).to_be_disabled()
        await expect(page.get_by_role("button", name="Edit keeper:notebook")).to_have_count(0)
        await page.get_by_role("button", name="Open another one").click()
        await expect(page.locator(".status")).to_have_text("live")
        await expect(page.get_by_role("button", name="Say", exact=True)).to_be_enabled()


@on_stage
async def test_on_a_phone_nothing_is_wider_than_the_screen(stage: Stage) -> None:
    off = """() => [...document.querySelectorAll("header *, .tools *, aside *")].filter(element => {
        const box = element.getBoundingClientRect();
        return box.width > 1 && box.right > innerWidth + 1;
    }).map(element => element.outerHTML.slice(0, 80))"""
    async with served() as host, stage.open(f"{host.address}board/", **PHONE) as page:
        await say(page, "Since when?")
        await until_lane(page, "keeper:answer", "done")
        assert await page.evaluate(off) == []
        await page.get_by_role("button", name="Diagram").click()
        await expect(node(page, "rule keeper:answer")).to_be_visible()
        assert await page.evaluate(off) == []
        await page.get_by_role("tab", name="Rule").click()
        assert await page.evaluate(off) == []


@on_stage
async def test_the_timeline_can_be_used_with_the_keyboard(stage: Stage) -> None:
    async with served() as host, stage.open(f"{host.address}board/") as page:
        await page.keyboard.press("/")
        await page.keyboard.type("small")
        await expect(page.locator("button.lane")).to_have_count(1)
        await page.keyboard.press("Enter")
        await expect(page.get_by_role("heading", name="keeper:small_talk")).to_be_visible()
        await expect(page.get_by_label("Filter rules")).to_have_value("")
        await page.keyboard.type("nowhere")
        await expect(page.get_by_text("no rule matches “nowhere”")).to_be_visible()
        await page.keyboard.press("Escape")
        await expect(page.get_by_label("Filter rules")).to_have_value("")
        await page.get_by_role("button", name="Close this rule").click()
        timeline = page.get_by_role("application", name="Timeline")
        await timeline.focus()
        await page.keyboard.press("ArrowDown")
        await expect(page.get_by_role("heading", name="keeper:classify")).to_be_visible()
        span = await page.evaluate("window.raveboard.view.span")
        await page.keyboard.press("+")
        assert await page.evaluate("window.raveboard.view.span") < span
        await page.keyboard.press("ArrowLeft")
        await expect(page.get_by_role("button", name="Follow", exact=True)).to_be_visible()
        await page.keyboard.press("End")
        await expect(page.get_by_role("button", name="Following")).to_be_visible()


@on_stage
async def test_the_diagram_can_be_used_with_the_keyboard(stage: Stage) -> None:
    async with (
        served(*(skill(number) for number in range(12))) as host,
        stage.open(f"{host.address}board/", viewport={"width": 900, "height": 600}) as page,
    ):
        await page.get_by_role("button", name="Diagram").click()
        await page.get_by_role("button", name="Unfold all").click()
        await expect(page.locator(".node.rule")).to_have_count(58)
        drawing = page.get_by_role("application", name="Signal-Rule-Slot diagram")
        await drawing.focus()
        place = page.locator("svg[role=application] > g")
        before = await place.get_attribute("transform")
        await page.keyboard.press("ArrowDown")
        moved = await place.get_attribute("transform")
        assert moved != before
        await page.keyboard.press("+")
        assert await place.get_attribute("transform") != moved
        focused = page.locator(".node:focus")
        for _ in range(15):
            await page.keyboard.press("Tab")
            await expect(focused).to_be_in_viewport()
        rule = await focused.get_attribute("data-id")
        assert rule is not None
        await page.keyboard.press("Enter")
        await expect(page.get_by_role("heading", name=rule.removeprefix("rule "))).to_be_visible()


@on_stage
async def test_the_board_keeps_painting_and_misses_nothing_at_a_thousand_events_a_second(stage: Stage) -> None:
    async with served() as host, stage.open(f"{host.address}board/") as page:
        await expect(page.locator(".status")).to_have_text("live")
        (session,) = host.sessions

        async def events() -> None:
            for number in range(150):
                for _ in range(20):
                    session.context.emit(question, f"{number}?")
                await passing(page, 0.02)

        raising = asyncio.create_task(events())
        frames = await page.evaluate(
            """() => new Promise(resolve => {
                const times = [];
                const tick = time => { times.push(time); times.length < 120 ? requestAnimationFrame(tick) : resolve(times); };
                requestAnimationFrame(tick);
            })"""
        )
        await raising
        await page.wait_for_function("() => window.raveboard.trace.spikes.length > 5000")
        assert len(frames) == 120  # the page painted frames all the time
        assert await page.evaluate("window.raveboard.missed") == 0


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("size", [{}, PHONE], ids=["desk", "phone"])
@on_stage
async def test_axe_finds_nothing_serious_in_any_view_of_the_board(
    stage: Stage, scheme: str, size: dict[str, Any]
) -> None:
    async with (
        served() as host,
        stage.open(f"{host.address}board/", complaints=True, color_scheme=scheme, **size) as page,
    ):
        found = [f"empty: {finding}" for finding in await findings(page)]
        await say(page, "Since when?")
        await until_lane(page, "keeper:answer", "done")
        found += [f"slots: {finding}" for finding in await findings(page)]
        await page.get_by_role("tab", name="Signals").click()
        found += [f"signals: {finding}" for finding in await findings(page)]
        await name(page, "keeper:small_talk").click()
        await expect(page.locator(".answer")).to_be_visible()
        found += [f"rule: {finding}" for finding in await findings(page)]
        await page.get_by_role("button", name="Diagram").click()
        await expect(page.get_by_role("application", name="Signal-Rule-Slot diagram")).to_be_visible()
        await page.get_by_role("button", name="Modules").click()
        found += [f"diagram: {finding}" for finding in await findings(page)]
    assert not found, "\n".join(found)


def test_the_scripts_of_the_page_are_within_the_size_limit() -> None:
    scripts = sum(len(gzip.compress(file.read_bytes())) for file in PAGE.rglob("*.js"))
    assert 0 < scripts < SCRIPT


@on_stage
async def test_the_pictures_in_the_documentation_can_be_taken(stage: Stage, tmp_path: Path) -> None:
    folder = Path(os.environ.get("PICTURES", tmp_path))
    size = {"width": 1280, "height": 720}
    async with (
        served() as host,
        stage.open(f"{host.address}board/", viewport=size, color_scheme="light") as page,
    ):
        await expect(page.locator(".status")).to_have_text("live")
        for text in ("Since when?", "Nice."):
            Cue.classified.clear()
            await say(page, text)
            await passing(page, 0.7)
            Cue.classified.set()
            await passing(page, 0.4)
        await name(page, "keeper:small_talk").click()
        await page.locator("#cause").select_option(index=1)
        await expect(page.locator(".answer")).to_have_attribute("data-verdict", "outrun")
        await page.get_by_role("button", name="All", exact=True).click()
        await page.mouse.move(600, 600)
        await drawn(page)
        await page.screenshot(path=folder / "board.png")
        await page.get_by_role("button", name="Close this rule").click()
        await page.get_by_role("button", name="Newest").click()
        await page.get_by_role("button", name="Diagram").click()
        await expect(node(page, "rule keeper:answer")).to_be_visible()
        Cue.classified.clear()
        await say(page, "By whom?")
        await expect(node(page, "rule keeper:small_talk")).to_have_attribute("data-state", "waiting")
        await page.get_by_role("tab", name="Rule").click()
        await expect(page.get_by_text("waits for keeper:answer")).to_be_visible()
        await passing(page, 0.6)
        await page.screenshot(path=folder / "board-diagram.png")
        Cue.classified.set()
    for picture in ("board.png", "board-diagram.png"):
        head = (folder / picture).read_bytes()[:24]
        assert struct.unpack(">II", head[16:24]) == (size["width"], size["height"])


@on_stage
async def test_the_board_follows_the_newest_conversation_of_its_browser(stage: Stage) -> None:
    async with served() as host, stage.open(f"{host.address}board/") as board:
        await expect(board.locator(".status")).to_have_text("live")
        page = await board.context.new_page()
        await page.goto(host.address)
        await page.get_by_label("What you say to Elske").fill("It is quiet here.")
        await page.get_by_label("What you say to Elske").press("Enter")
        await until_lane(board, "keeper:small_talk", "done")
        later = await board.context.new_page()
        await later.goto(f"{host.address}board/")
        await until_lane(later, "keeper:small_talk", "done")


dancer = rs.Module("dancer", requires=(rawio,))


@dancer.rule(when=rawio.input.changed, writes=rawio.output, until=rawio.input.changed)
async def dance(ctx: rs.RuleContext) -> None:
    """Dance until somebody speaks."""
    await ctx.sleep(600.0)


@on_stage
async def test_the_timeline_has_a_sign_for_an_interrupted_run(stage: Stage) -> None:
    async with served(dancer) as host, stage.open(f"{host.address}board/", color_scheme="light") as page:
        await say(page, "Dance!")
        await page.wait_for_function(
            "() => window.raveboard.trace.lanes.get('dancer:dance')?.bars[0]?.phases.at(-1)?.state === 'running'"
        )
        await drawn(page)
        assert "interrupted" not in await painted(page, "dancer:dance")
        await say(page, "Stop.")
        await page.wait_for_function(
            "() => window.raveboard.trace.lanes.get('dancer:dance')?.bars[0]?.outcome === 'interrupted'"
        )
        await page.get_by_role("button", name="All", exact=True).click()
        await drawn(page)
        assert "interrupted" in await painted(page, "dancer:dance")


clumsy = rs.Module("clumsy", requires=(rawio,))


@clumsy.rule(when=rawio.input.changed, writes=rawio.output)
async def spill(ctx: rs.RuleContext) -> None:
    """Raise an error."""
    raise ValueError("out of ink")


@on_stage
async def test_a_failure_is_counted_and_shows_its_traceback(stage: Stage) -> None:
    async with served(clumsy) as host, stage.open(f"{host.address}board/") as page:
        await say(page, "Write this down.")
        await page.get_by_role("button", name="1 failed").click()
        await expect(page.get_by_role("heading", name="clumsy:spill")).to_be_visible()
        await expect(page.locator("pre")).to_contain_text("Traceback (most recent call last)")
        await expect(page.locator("pre")).to_contain_text('raise ValueError("out of ink")')


@on_stage
async def test_the_picture_of_the_chat_and_its_board_can_be_taken(stage: Stage, tmp_path: Path) -> None:
    picture = Path(os.environ.get("PICTURES", tmp_path)) / "chat-and-board.png"
    chat_size, board_size = {"width": 480, "height": 720}, {"width": 1120, "height": 720}
    async with (
        served() as host,
        stage.open(host.address, viewport=chat_size, color_scheme="light") as chat,
        stage.open(f"{host.address}board/", viewport=board_size, color_scheme="light") as page,
    ):
        field = chat.get_by_label("What you say to Elske")
        for number, text in enumerate(("How long has this been an inn?", "I like it here."), start=1):
            Cue.classified.clear()
            await field.fill(text)
            await field.press("Enter")
            await passing(page, 0.6)
            Cue.classified.set()
            await expect(chat.locator(".line.agent")).to_have_count(number)
        await name(page, "keeper:small_talk").click()
        await page.get_by_role("button", name="All", exact=True).click()
        await page.mouse.move(600, 600)
        await drawn(page)
        await chat.evaluate("document.fonts.ready")
        shots = [base64.b64encode(await each.screenshot()).decode() for each in (chat, page)]
        images = "".join(f'<img src="data:image/png;base64,{shot}">' for shot in shots)
        style = "body{margin:0;display:flex;gap:12px;padding:12px;background:#fff}img{border:1px solid #ccc;border-radius:8px}"
        await page.set_viewport_size({"width": 1640, "height": 748})
        await page.goto("about:blank")
        await page.set_content(f"<style>{style}</style>{images}")
        await page.screenshot(path=picture)
    assert picture.read_bytes().startswith(b"\x89PNG")
