"""The chat page in a real browser: conversations, lost connections, phones, the keyboard, and the token."""

import asyncio
from typing import Any

from playwright.async_api import Page, WebSocketRoute, expect

from end_to_end.host import Cue, host, namesake, storyteller, watcher
from end_to_end.stage import PHONE, Stage, on_stage
from ravestate.modules import webio
from ravestate.modules.platform.webio.server import Server
from ravestate.modules.platform.webio.session import Ending
from ravestate.runtime.agent import Agent

TOKEN = "open sesame, please"


def log(page: Page) -> Any:
    return page.get_by_role("log")


def lines(page: Page) -> Any:
    return page.locator(".line")


async def say(page: Page, text: str) -> None:
    field = page.get_by_label("What you say to")
    await field.fill(text)
    await field.press("Enter")


async def said(page: Page, *texts: str) -> None:
    """Wait until the page shows exactly these messages. A message of the visitor begins with ``> ``."""
    await expect(lines(page)).to_have_text([f"{who} {text}" for who, text in map(spoken, texts)])


def spoken(text: str) -> tuple[str, str]:
    mine = text.startswith("> ")
    return ("You:", text[2:]) if mine else ("Elske:", text)


@on_stage
async def test_a_visitor_talks_with_the_agent(stage: Stage) -> None:
    async with stage.serve(host, title="Elske") as served, stage.open(served.address) as page:
        await expect(page).to_have_title("Elske")
        await said(page, "Good evening.")
        await expect(page.get_by_label("What you say to Elske")).to_be_focused()
        await say(page, "It is quiet here. 🙂")
        await said(page, "Good evening.", "> It is quiet here. 🙂", "You said: It is quiet here. 🙂")
        await expect(page.get_by_label("What you say to Elske")).to_have_value("")


@on_stage
async def test_the_agent_learns_that_the_visitor_is_typing_but_not_at_every_key_press(stage: Stage) -> None:
    async with stage.serve(host, watcher, title="Elske") as served, stage.open(served.address) as page:
        await said(page, "Good evening.")
        text = "It is quiet here, and yet I hear the raven."
        await page.get_by_label("What you say to Elske").press_sequentially(text)
        await page.keyboard.press("Enter")
        await expect(log(page)).to_contain_text(f"You said: {text}")
        told = await log(page).get_by_text("You are writing.").count()
        assert 1 <= told < len(text) / 4  # the page reports typing at most once every two seconds


@on_stage
async def test_the_page_shows_the_agents_name(stage: Stage) -> None:
    async with stage.serve(host, namesake) as served, stage.open(served.address) as page:
        await expect(page).to_have_title("Ravestate")
        await say(page, "I call you Robin")
        await expect(page).to_have_title("Robin")
        await expect(page.get_by_role("heading", level=1)).to_have_text("Robin")
        await expect(page.get_by_label("What you say to Robin")).to_be_focused()
        await page.reload()
        await expect(page).to_have_title("Robin")


@on_stage
async def test_the_page_shows_that_the_agent_thinks_and_then_speaks(stage: Stage) -> None:
    Cue.thought, Cue.told = asyncio.Event(), asyncio.Event()
    async with stage.serve(host, storyteller, title="Elske") as served, stage.open(served.address) as page:
        await said(page, "Good evening.")
        await say(page, "Tell me a story.")
        await expect(log(page)).to_contain_text("Elske is thinking.")
        Cue.thought.set()
        growing = page.locator(".partial")
        await expect(growing).to_have_text("Once upon a time")
        # A screen reader reads the utterance only when it is complete.
        await expect(growing).to_have_attribute("aria-hidden", "true")
        await expect(log(page)).not_to_contain_text("is thinking")
        Cue.told.set()
        await said(page, "Good evening.", "> Tell me a story.", "Once upon a time there was a raven.")


@on_stage
async def test_a_reload_in_the_middle_of_an_utterance_loses_nothing(stage: Stage) -> None:
    Cue.thought, Cue.told = asyncio.Event(), asyncio.Event()
    async with stage.serve(host, storyteller, title="Elske") as served, stage.open(served.address) as page:
        await said(page, "Good evening.")
        await say(page, "Tell me a story.")
        Cue.thought.set()
        await expect(page.locator(".partial")).to_have_text("Once upon a time")
        await page.reload()
        await expect(page.locator(".partial")).to_have_text("Once upon a time")
        Cue.told.set()
        whole = ("Good evening.", "> Tell me a story.", "Once upon a time there was a raven.")
        await said(page, *whole)
        await page.reload()
        await said(page, *whole)
        assert len(served.sessions) == 1


@on_stage
async def test_two_visitors_have_separate_conversations(stage: Stage) -> None:
    async with (
        stage.serve(host, title="Elske") as served,
        stage.open(served.address) as ada,
        stage.open(served.address) as bob,
    ):
        await asyncio.gather(say(ada, "I am Ada."), say(bob, "I am Bob."))
        await expect(log(ada)).to_contain_text("You said: I am Ada.")
        await expect(log(bob)).to_contain_text("You said: I am Bob.")
        await expect(log(ada)).not_to_contain_text("Bob")
        await expect(log(bob)).not_to_contain_text("Ada")


@on_stage
async def test_a_lost_connection_loses_nothing(stage: Stage) -> None:
    async with (
        stage.serve(host, title="Elske") as served,
        stage.open(served.address, complaints=True) as page,
    ):
        await said(page, "Good evening.")
        with served.away():
            await expect(page.get_by_text("The connection is lost.")).to_be_visible()
            await say(page, "Are you there?")
            await expect(page.locator(".pending")).to_have_text("You: Are you there? (not sent yet)")
            served.sessions[0].utter("I was gone for a while.")
        await said(page, "Good evening.", "I was gone for a while.", "> Are you there?", "You said: Are you there?")
        await expect(page.get_by_text("The connection is lost.")).to_be_hidden()
        await expect(page.locator(".pending")).to_have_count(0)


@on_stage
async def test_repeatedly_lost_connections_lose_nothing(stage: Stage) -> None:
    async with (
        stage.serve(host, title="Elske") as served,
        stage.open(served.address, complaints=True) as page,
    ):
        await said(page, "Good evening.")
        for number in range(5):
            await say(page, f"{number}")
            served.drop()
        await expect(page.locator(".pending")).to_have_count(0)
        await expect(page.locator(".user")).to_have_text([f"You: {number}" for number in range(5)])
        await expect(page.locator(".agent")).to_have_text(
            ["Elske: Good evening.", *(f"Elske: You said: {number}" for number in range(5))]
        )


@on_stage
async def test_a_conversation_that_ended_during_a_lost_connection_is_followed_by_a_new_one(stage: Stage) -> None:
    async with (
        stage.serve(host, title="Elske") as first,
        stage.open(first.address, complaints=True) as page,
    ):
        await said(page, "Good evening.")
        with first.away():
            await expect(page.get_by_text("The connection is lost.")).to_be_visible()
            sessions = first.app.state.sessions
            sessions.leave(first.sessions[0], Ending.ABANDONED)
        await expect(page.get_by_text("A new conversation")).to_be_visible()
        await said(page, "Good evening.", "Good evening.")


@on_stage
async def test_when_the_agent_is_switched_off_the_page_says_so(stage: Stage) -> None:
    async with stage.serve(host, title="Elske") as served, stage.open(served.address) as page:
        await said(page, "Good evening.")
        await served.app.state.sessions.close()
        await said(page, "Good evening.", "Until next time!")
        await expect(page.get_by_text("The agent has been switched off.")).to_be_visible()


@on_stage
async def test_a_script_in_a_message_or_title_is_shown_as_text(stage: Stage) -> None:
    script = "<img src=x onerror='hacked=1'><script>hacked=1</script><svg onload=hacked=1>{@html 1}"
    async with stage.serve(host, title=script) as served, stage.open(served.address) as page:
        await say(page, script)
        await expect(log(page)).to_contain_text(f"You said: {script}")
        await expect(page).to_have_title(script)
        await expect(page.get_by_role("heading", level=1)).to_have_text(script)
        assert await page.evaluate("typeof hacked") == "undefined"
        assert await page.locator(".line img, .line script, .line svg, h1 img").count() == 0


@on_stage
async def test_the_page_runs_no_injected_script(stage: Stage) -> None:
    async with stage.serve(host) as served, stage.open(served.address, complaints=True) as page:
        await page.evaluate(
            "() => { const s = document.createElement('script'); s.textContent = 'window.hacked = 1';"
            " document.body.append(s); document.body.insertAdjacentHTML('beforeend',"
            " '<img src=x onerror=\"window.hacked = 1\">'); }"
        )
        await page.wait_for_function("[...document.images].every((image) => image.complete)")
        assert await page.evaluate("typeof hacked") == "undefined"


@on_stage
async def test_on_a_phone_long_messages_fit_the_screen(stage: Stage) -> None:
    async with stage.serve(host, title="Elske") as served, stage.open(served.address, **PHONE) as page:
        await said(page, "Good evening.")
        for text in ("w" * 300, "a long sentence, such as one has to read on a small screen, " * 5):
            await say(page, text)
            await expect(log(page)).to_contain_text(f"You said: {text.strip()}")
        assert await page.evaluate("document.documentElement.scrollWidth <= innerWidth")
        assert await page.evaluate(
            "[...document.querySelectorAll('.line')].every((line) => line.scrollWidth <= line.clientWidth + 1)"
        )
        await expect(lines(page).last).to_be_in_viewport()
        await expect(page.get_by_label("What you say to Elske")).to_be_in_viewport(ratio=1)


@on_stage
async def test_on_a_phone_all_controls_are_large_enough_for_a_finger(stage: Stage) -> None:
    agent = Agent(host, webio, settings={"webio": {"port": 0, "token": TOKEN}})

    async def check(page: Page) -> None:
        found = page.locator("button, a, input, textarea").filter(visible=True)
        assert await found.count() > 0
        for target in await found.all():
            box = await target.bounding_box()
            assert box is not None
            assert min(box["width"], box["height"]) >= 44, await target.evaluate("(it) => it.outerHTML")

    async with Server(agent, inside="board/") as served, stage.open(served.address, **PHONE) as page:
        await expect(page.get_by_label("Token")).to_be_visible()
        await check(page)
        await page.get_by_label("Token").fill(TOKEN)
        await page.get_by_label("Token").press("Enter")
        await expect(page.get_by_role("button", name="Who are you?")).to_be_visible()
        await check(page)
        for number in range(20):
            await say(page, f"{number}")
        await expect(log(page)).to_contain_text("You said: 19")
        await log(page).evaluate("(log) => { log.scrollTop = 0; }")
        await expect(page.get_by_role("button", name="Newest")).to_be_visible()
        await check(page)
        await page.get_by_role("button", name="Leave").click()
        await check(page)
        await page.get_by_role("dialog").get_by_role("button", name="Leave").click()
        await expect(page.get_by_role("button", name="Begin a new conversation")).to_be_visible()
        await check(page)


@on_stage
async def test_a_new_conversation_suggests_three_things_to_say(stage: Stage) -> None:
    async with stage.serve(host, title="Elske") as served, stage.open(served.address, **PHONE) as page:
        offered = page.get_by_role("list", name="Things to say").get_by_role("button")
        await expect(offered).to_have_text(["Hello!", "Who are you?", "What can you do?"])
        await offered.nth(1).click()
        await said(page, "Good evening.", "> Who are you?", "You said: Who are you?")
        await expect(offered).to_have_count(0)


@on_stage
async def test_equal_suggestions_and_long_suggestions_are_shown_in_full_on_a_small_screen(stage: Stage) -> None:
    offered = ("Hello!", "Hello!", *("w" * 79 + str(number) for number in range(4)))
    small = {"viewport": {"width": 320, "height": 480}}
    async with (
        stage.serve(host, title="Elske", suggestions=offered) as served,
        stage.open(served.address, **small) as page,
    ):
        await expect(page.get_by_role("list", name="Things to say").get_by_role("button")).to_have_count(6)
        await expect(page.get_by_role("button", name="Hello!")).to_have_count(2)
        assert await page.evaluate("document.documentElement.scrollWidth") == 320
        assert (await log(page).bounding_box())["height"] > 100
        await page.get_by_role("button", name="Hello!").first.click()
        await said(page, "Good evening.", "> Hello!", "You said: Hello!")


@on_stage
async def test_the_status_shows_that_the_agent_is_paused(stage: Stage) -> None:
    async with stage.serve(host, title="Elske") as served, stage.open(served.address) as page:
        status = page.locator(".status")
        await expect(status).to_have_text("here")
        (session,) = served.sessions
        session.context.pause()
        session.notify()
        await expect(status).to_have_text("paused")
        await say(page, "Are you there?")
        session.context.resume()
        session.notify()
        await expect(status).to_have_text("here")
        await said(page, "Good evening.", "> Are you there?", "You said: Are you there?")


@on_stage
async def test_the_status_shows_that_the_server_does_not_respond(stage: Stage) -> None:
    async with stage.serve(host, title="Elske") as served, stage.open("about:blank") as page:
        await page.clock.install()
        frozen = False

        def meet(client: WebSocketRoute) -> None:
            server = client.connect_to_server()
            server.on_message(lambda text: None if frozen else client.send(text))

        await page.route_web_socket("**/ws", meet)
        await page.goto(served.address)
        await expect(page.locator(".status")).to_have_text("here")
        frozen = True
        await say(page, "Are you there?")
        await page.clock.fast_forward(5_000)
        await expect(page.locator(".status")).to_have_text("not responding")
        frozen = False
        served.sessions[0].utter("I was far away.")
        await expect(page.locator(".status")).to_have_text("here")


@on_stage
async def test_in_a_conversation_of_5000_lines_the_page_holds_only_the_lines_near_the_view(stage: Stage) -> None:
    async with stage.serve(host, title="Elske") as served, stage.open(served.address) as page:
        await said(page, "Good evening.")
        (session,) = served.sessions
        for start in range(0, 5_000, 250):
            for number in range(start, start + 250):
                session.utter(f"Line {number}" + ", which is long" * (number % 40))
            await expect(lines(page).last).to_contain_text(f"Line {start + 249}")
        nodes = "document.querySelectorAll('*').length"
        assert await page.evaluate(nodes) < 800
        await expect(lines(page).last).to_be_in_viewport()
        await log(page).evaluate("(log) => { log.scrollTop = 0; }")
        await expect(page.get_by_text("Good evening.")).to_be_in_viewport()
        assert await page.evaluate(nodes) < 800
        await log(page).focus()
        place = "(log) => log.scrollTop"
        for _ in range(5):
            before = await log(page).evaluate(place)
            await page.keyboard.press("PageDown")
            await page.wait_for_function(
                f"(before) => ({place})(document.querySelector('[role=log]')) > before", arg=before
            )
        shown = await seen(page)
        assert 1 < len(shown) == shown[-1] - shown[0] + 1  # the lines in view have no gap
        session.utter("Something new.")
        await expect(page.get_by_role("button", name="Newest")).to_be_visible()
        await page.mouse.move(300, 300)
        for _ in range(30):
            await page.mouse.wheel(0, -400)
            await page.evaluate("() => new Promise(requestAnimationFrame)")
        await expect(page.get_by_text("Good evening.")).to_be_in_viewport()
        await page.get_by_role("button", name="Newest").click()
        await expect(lines(page).last).to_have_text("Elske: Something new.")
        await expect(lines(page).last).to_be_in_viewport()
        assert await page.evaluate(nodes) < 800


@on_stage
async def test_scrolling_up_does_not_make_the_lines_in_view_jump(stage: Stage) -> None:
    async with stage.serve(host, title="Elske") as served, stage.open(served.address) as page:
        await said(page, "Good evening.")
        (session,) = served.sessions
        for number in range(400):
            session.utter(f"Line {number}" + ", which is long" * (number % 40))
        await expect(lines(page).last).to_contain_text("Line 399")
        await page.mouse.move(300, 300)
        first = (await seen(page))[0]
        while first > 100:  # scroll up to lines whose heights the page has only estimated
            await page.mouse.wheel(0, -300)
            await page.wait_for_function(
                "(first) => [...document.querySelectorAll('.line')].some((line) => line.textContent.includes("
                "`Line ${first - 1}`) && line.getBoundingClientRect().bottom > 60)",
                arg=first,
            )
            shown = await seen(page)
            assert shown[-1] - shown[0] + 1 == len(shown)
            assert first - shown[0] < 30  # the view moved by one turn of the wheel, not more
            first = shown[0]


async def seen(page: Page) -> list[int]:
    """Return the numbers of the lines in view."""
    return await log(page).evaluate(
        "(log) => { const view = log.getBoundingClientRect(); return [...log.querySelectorAll('.line')]"
        ".filter((line) => { const box = line.getBoundingClientRect();"
        " return box.bottom > view.top && box.top < view.bottom; })"
        ".map((line) => Number(/Line ([0-9]+)/.exec(line.textContent)?.[1])); }"
    )


@on_stage
async def test_on_a_phone_the_agents_name_is_not_cut(stage: Stage) -> None:
    agent = Agent(host, webio, settings={"webio": {"port": 0}})
    async with Server(agent, inside="board/") as served, stage.open(served.address, **PHONE) as page:
        await expect(page.get_by_role("link", name="Look inside")).to_be_in_viewport(ratio=1)
        await expect(page.get_by_role("button", name="Leave")).to_be_in_viewport(ratio=1)
        await expect(page.get_by_text("here", exact=True)).to_be_attached()  # hidden, but for screen readers
        name = page.get_by_role("heading", name="Ravestate")
        assert await name.evaluate("(name) => name.scrollWidth <= name.clientWidth")


@on_stage
async def test_on_a_phone_a_long_unsent_text_fits(stage: Stage) -> None:
    async with stage.serve(host, title="Elske") as served, stage.open(served.address, **PHONE) as page:
        await said(page, "Good evening.")
        await page.get_by_label("What you say to Elske").fill("https://museum.example/" + "w" * 300)
        send = await page.get_by_role("button", name="Send").bounding_box()
        assert send is not None
        assert send["x"] + send["width"] <= PHONE["viewport"]["width"]


@on_stage
async def test_a_text_that_is_too_long_stays_in_the_field(stage: Stage) -> None:
    async with stage.serve(host, title="Elske") as served, stage.open(served.address) as page:
        await said(page, "Good evening.")
        field, text = page.get_by_label("What you say to Elske"), "word " * 2_000 + "end"
        await field.fill(text)
        await field.press("Enter")
        await expect(page.get_by_role("alert")).to_have_text("10,003 characters; at most 10,000 can be said at once.")
        await expect(field).to_have_value(text)
        await field.fill(text[5:])
        await field.press("Enter")
        await expect(page.locator(".agent").last).to_have_text(f"Elske: You said: {text[5:]}")


@on_stage
async def test_a_text_that_the_server_refuses_is_not_sent_again(stage: Stage) -> None:
    async with (
        stage.serve(host, title="Elske") as served,
        stage.open(served.address, complaints=True) as page,
    ):
        await said(page, "Good evening.")
        await say(page, "\u0085")  # the server counts this as white space, but the page does not
        await expect(page.locator(".pending")).to_contain_text("(not taken)")
        await say(page, "hello")
        await expect(log(page)).to_contain_text("You said: hello")
        served.drop()
        await say(page, "again")
        await expect(log(page)).to_contain_text("You said: again")
        await page.reload()
        await said(page, "Good evening.", "> hello", "You said: hello", "> again", "You said: again")


@on_stage
async def test_two_windows_of_one_conversation_show_the_same_messages(stage: Stage) -> None:
    async with stage.serve(host, title="Elske") as served, stage.open(served.address) as page:
        await said(page, "Good evening.")
        async with page.expect_popup() as opened:  # the new window gets a copy of this window's storage
            await page.evaluate("window.open(location.href)")
        other = await opened.value
        await said(other, "Good evening.")
        await say(page, "one")
        await expect(log(other)).to_contain_text("You said: one")
        await say(other, "two")
        whole = ("Good evening.", "> one", "You said: one", "> two", "You said: two")
        await said(page, *whole)
        await said(other, *whole)
        assert len(served.sessions) == 1
        await page.close()
        await say(other, "three")
        await expect(log(other)).to_contain_text("You said: three")


@on_stage
async def test_the_page_works_with_the_keyboard_alone(stage: Stage) -> None:
    async with stage.serve(host, title="Elske") as served, stage.open(served.address) as page:
        await said(page, "Good evening.")
        keys = page.keyboard
        await keys.type("one")
        await keys.press("Shift+Enter")
        await keys.type("two")
        await keys.press("Tab")
        await expect(page.get_by_role("button", name="Send")).to_be_focused()
        await keys.press("Space")
        await expect(page.locator(".user")).to_have_text("You: one\ntwo", use_inner_text=False)
        await expect(page.get_by_label("What you say to Elske")).to_be_focused()
        await keys.press("Shift+Tab")
        await expect(log(page)).to_be_focused()
        await keys.press("Shift+Tab")
        await expect(page.get_by_role("button", name="Leave")).to_be_focused()
        await keys.press("Enter")
        dialog = page.get_by_role("dialog", name="Leave the conversation?")
        await expect(dialog.get_by_role("button", name="Stay")).to_be_focused()
        await keys.press("Escape")
        await expect(dialog).to_be_hidden()
        await expect(page.get_by_role("button", name="Leave")).to_be_focused()
        await keys.press("Enter")
        await keys.press("Tab")
        await keys.press("Enter")
        await expect(log(page)).to_contain_text("Until next time!")
        await expect(page.get_by_role("button", name="Begin a new conversation")).to_be_focused()
        await keys.press("Enter")
        await said(page, "Good evening.")
        await expect(page.get_by_label("What you say to Elske")).to_be_focused()


@on_stage
async def test_the_page_does_not_scroll_while_the_visitor_reads_further_up(stage: Stage) -> None:
    async with stage.serve(host, title="Elske") as served, stage.open(served.address, **PHONE) as page:
        await said(page, "Good evening.")
        for number in range(12):
            await say(page, f"{number}")
            await expect(lines(page)).to_have_count(2 * number + 3)
        await expect(lines(page).last).to_be_in_viewport()
        await log(page).evaluate("(log) => { log.scrollTop = 0; }")
        newest = page.get_by_role("button", name="Newest")
        await expect(newest).to_be_visible()
        served.sessions[0].utter("Something new.")
        await expect(lines(page)).to_have_count(26)
        await expect(lines(page).first).to_be_in_viewport()
        await newest.click()
        await expect(lines(page).last).to_be_in_viewport()
        await expect(newest).to_be_hidden()


@on_stage
async def test_in_a_long_conversation_only_the_log_scrolls_and_its_last_line_is_visible(stage: Stage) -> None:
    async with stage.serve(host, title="Elske") as served, stage.open(served.address, **PHONE) as page:
        await said(page, "Good evening.")
        for number in range(12):
            await say(page, f"{number}")
            await expect(lines(page)).to_have_count(2 * number + 3)
        grown = "document.documentElement.scrollHeight - document.documentElement.clientHeight"
        assert await page.evaluate(grown) == 0
        (session,) = served.sessions
        served.app.state.sessions.leave(session, Ending.BYE)
        await expect(page.get_by_role("button", name="Begin a new conversation")).to_be_visible()
        await expect(lines(page).last).to_have_text("Elske: Until next time!")
        await expect(lines(page).last).to_be_in_viewport(ratio=1)
        assert await page.evaluate(grown) == 0


@on_stage
async def test_a_link_with_the_token_opens_the_page_and_hides_the_token(stage: Stage) -> None:
    async with (
        stage.serve(host, title="Elske", token=TOKEN) as served,
        stage.open(f"{served.address}#token={TOKEN.replace(' ', '%20')}") as page,
    ):
        await said(page, "Good evening.")
        assert TOKEN.split()[0] not in page.url
        await page.reload()
        await said(page, "Good evening.")


@on_stage
async def test_without_a_token_the_page_asks_for_it(stage: Stage) -> None:
    async with (
        stage.serve(host, title="Elske", token=TOKEN) as served,
        stage.open(served.address) as page,
    ):
        await expect(page.get_by_text("A token is needed.")).to_be_visible()
        await page.get_by_label("Token").fill("a guess")
        await page.get_by_label("Token").press("Enter")
        await expect(page.get_by_text("The token is wrong.")).to_be_visible()
        await page.get_by_label("Token").fill(TOKEN)
        await page.get_by_label("Token").press("Enter")
        await said(page, "Good evening.")
