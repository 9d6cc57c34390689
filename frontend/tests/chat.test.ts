import { cleanup, fireEvent, render, screen } from "@testing-library/svelte";
import { afterEach, expect, test, vi } from "vitest";
import Composer from "../src/chat/Composer.svelte";
import Log from "../src/chat/Log.svelte";
import { Conversation } from "../src/lib/conversation.svelte";
import { TestSocket } from "./socket";

afterEach(cleanup);

test("Enter says it, Shift-Enter begins a line, and while a character is composed it does neither", async () => {
  const onsay = vi.fn();
  render(Composer, { agent: "Elske", closed: false, onsay });
  const field = screen.getByLabelText("What you say to Elske");
  await fireEvent.input(field, { target: { value: " hello " } });
  await fireEvent.keyDown(field, { key: "Enter", shiftKey: true });
  await fireEvent.keyDown(field, { key: "Enter", isComposing: true });
  expect(onsay).not.toHaveBeenCalled();
  await fireEvent.keyDown(field, { key: "Enter" });
  expect(onsay).toHaveBeenCalledExactlyOnceWith("hello");
  expect(field).toHaveProperty("value", "");
});

test("nothing is not said", async () => {
  const onsay = vi.fn();
  render(Composer, { agent: "Elske", closed: false, onsay });
  await fireEvent.keyDown(screen.getByLabelText("What you say to Elske"), { key: "Enter" });
  expect(onsay).not.toHaveBeenCalled();
  expect(screen.getByRole("button", { name: "Send" })).toHaveProperty("disabled", true);
});

test("what looks like HTML is shown as text", async () => {
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
