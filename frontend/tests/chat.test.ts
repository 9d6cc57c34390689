import { cleanup, fireEvent, render, screen } from "@testing-library/svelte";
import { tick } from "svelte";
import { afterEach, expect, test, vi } from "vitest";
import Composer from "../src/chat/Composer.svelte";
import Header from "../src/chat/Header.svelte";
import Log from "../src/chat/Log.svelte";
import Suggestions from "../src/chat/Suggestions.svelte";
import { Conversation } from "../src/lib/conversation.svelte";
import { TestSocket } from "./socket";

afterEach(() => {
  cleanup();
  sessionStorage.clear();
});

test("Enter sends the text, but not with Shift, and not while a character is composed", async () => {
  const onsay = vi.fn();
  render(Composer, { agent: "Elske", closed: false, onwrite: vi.fn(), onsay });
  const field = screen.getByLabelText("What you say to Elske");
  await fireEvent.input(field, { target: { value: " hello " } });
  await fireEvent.keyDown(field, { key: "Enter", shiftKey: true });
  await fireEvent.keyDown(field, { key: "Enter", isComposing: true });
  expect(onsay).not.toHaveBeenCalled();
  await fireEvent.keyDown(field, { key: "Enter" });
  expect(onsay).toHaveBeenCalledExactlyOnceWith("hello");
  expect(field).toHaveProperty("value", "");
});

test("the field reports typing, but not while it is blank", async () => {
  const onwrite = vi.fn();
  render(Composer, { agent: "Elske", closed: false, onwrite, onsay: vi.fn() });
  const field = screen.getByLabelText("What you say to Elske");
  await fireEvent.keyDown(field, { key: "ArrowLeft" });
  await fireEvent.input(field, { target: { value: " " } });
  expect(onwrite).not.toHaveBeenCalled();
  await fireEvent.input(field, { target: { value: " h" } });
  expect(onwrite).toHaveBeenCalledOnce();
  await fireEvent.input(field, { target: { value: "" } });
  await fireEvent.keyDown(field, { key: "Enter" });
  expect(onwrite).toHaveBeenCalledOnce();
});

test("in Safari, the Enter that ends a composition sends nothing", async () => {
  const onsay = vi.fn();
  render(Composer, { agent: "Elske", closed: false, onwrite: vi.fn(), onsay });
  const field = screen.getByLabelText("What you say to Elske");
  await fireEvent.input(field, { target: { value: "東京" } });
  await fireEvent.keyDown(field, { key: "Enter", keyCode: 229 });
  expect(onsay).not.toHaveBeenCalled();
});

test("a text that is too long is neither cut nor sent, and an alert says why", async () => {
  const onsay = vi.fn();
  render(Composer, { agent: "Elske", closed: false, onwrite: vi.fn(), onsay });
  const field = screen.getByLabelText("What you say to Elske");
  const text = "x".repeat(10_001);
  await fireEvent.input(field, { target: { value: text } });
  await fireEvent.keyDown(field, { key: "Enter" });
  expect(onsay).not.toHaveBeenCalled();
  expect(field).toHaveProperty("value", text);
  expect(screen.getByRole("alert").textContent).toContain("10,001 characters; at most 10,000");
  expect(field.getAttribute("aria-invalid")).toBe("true");
  await fireEvent.input(field, { target: { value: text.slice(1) } });
  expect(screen.queryByRole("alert")).toBeNull();
  await fireEvent.keyDown(field, { key: "Enter" });
  expect(onsay).toHaveBeenCalledExactlyOnceWith(text.slice(1));
});

test("an empty text is not sent", async () => {
  const onsay = vi.fn();
  render(Composer, { agent: "Elske", closed: false, onwrite: vi.fn(), onsay });
  await fireEvent.keyDown(screen.getByLabelText("What you say to Elske"), { key: "Enter" });
  expect(onsay).not.toHaveBeenCalled();
  expect(screen.getByRole("button", { name: "Send" })).toHaveProperty("disabled", true);
});

test("a message with HTML is shown as plain text", async () => {
  const conversation = new Conversation({ open: TestSocket.make });
  conversation.start();
  TestSocket.newest.welcome("s");
  const text = "<img src=x onerror=alert(1)>";
  TestSocket.newest.tell({ type: "message", n: 1, from: "agent", text, time: 0 });
  const { container } = render(Log, { conversation });
  expect(container.querySelector("img")).toBeNull();
  expect(screen.getByRole("log").textContent).toContain(text);
  conversation.stop();
});

test("the header says that the agent is paused, or does not respond", async () => {
  vi.useFakeTimers();
  const conversation = new Conversation({ open: TestSocket.make });
  conversation.start();
  const server = TestSocket.newest;
  server.welcome("s");
  const { container } = render(Header, { conversation });
  const status = () => container.querySelector(".status")?.textContent;
  expect(status()).toBe("here");
  server.tell({ type: "paused", on: true });
  await tick();
  expect(status()).toBe("paused");
  server.tell({ type: "paused", on: false });
  await tick();
  expect(status()).toBe("here");
  conversation.say("hello");
  vi.advanceTimersByTime(5_000);
  await tick();
  expect(status()).toBe("not responding");
  server.tell({ type: "pong" });
  await tick();
  expect(status()).toBe("here");
  conversation.stop();
  vi.useRealTimers();
});

test("the page suggests things to say until the visitor says something", async () => {
  const conversation = new Conversation({ open: TestSocket.make });
  conversation.start();
  TestSocket.newest.open();
  TestSocket.newest.tell({
    type: "welcome",
    v: 1,
    session: "s",
    resumed: false,
    first: 1,
    agent: "Elske",
    suggestions: ["Hello!", "Who are you?"],
  });
  render(Suggestions, { conversation });
  expect(screen.getAllByRole("button").map((button) => button.textContent)).toEqual([
    "Hello!",
    "Who are you?",
  ]);
  await fireEvent.click(screen.getByRole("button", { name: "Who are you?" }));
  expect(TestSocket.newest.sent.at(-1)).toMatchObject({ type: "say", text: "Who are you?" });
  expect(screen.queryByRole("button")).toBeNull();
  conversation.stop();
});

test("a note shows until the visitor says something, and only once in each browser", async () => {
  localStorage.clear();
  const begin = () => {
    const conversation = new Conversation({ open: TestSocket.make });
    conversation.start();
    TestSocket.newest.open();
    TestSocket.newest.tell({
      type: "welcome",
      v: 1,
      session: "s",
      resumed: false,
      first: 1,
      agent: "Elske",
      note: "Small talk without a language model.",
    });
    return conversation;
  };
  const first = begin();
  const { unmount } = render(Suggestions, { conversation: first });
  expect(screen.getByText("Small talk without a language model.")).toBeTruthy();
  first.say("Hello!");
  await tick();
  expect(screen.queryByText("Small talk without a language model.")).toBeNull();
  first.stop();
  unmount();
  const second = begin();
  render(Suggestions, { conversation: second });
  expect(screen.queryByText("Small talk without a language model.")).toBeNull();
  second.stop();
});

test("of five thousand lines, only the lines near the view are in the DOM", async () => {
  const conversation = new Conversation({ open: TestSocket.make });
  conversation.start();
  TestSocket.newest.welcome("s");
  const { container } = render(Log, { conversation });
  for (let n = 1; n <= 5000; n += 1) {
    TestSocket.newest.tell({ type: "message", n, from: "agent", text: `Line ${n}`, time: 0 });
  }
  await tick();
  const lines = container.querySelectorAll(".line");
  expect(lines.length).toBeLessThan(200);
  expect(lines[lines.length - 1]?.textContent).toContain("Line 5000");
  conversation.stop();
});
