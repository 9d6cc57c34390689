import { expect, test } from "vitest";
import { parse } from "../src/lib/frames";

test("a frame of each type is read", () => {
  expect(parse('{"type":"message","n":1,"from":"agent","text":"Hi","time":5}')).toMatchObject({ n: 1 });
  expect(parse('{"type":"pong"}')).toEqual({ type: "pong" });
});

test.each([
  "",
  "nonsense",
  "[]",
  "null",
  '"pong"',
  '{"type":7}',
  '{"type":"toString"}',
  '{"type":"new in version 2"}',
  '{"type":"message","n":"1","from":"agent","text":"Hi","time":5}',
  '{"type":"typing"}',
  '{"type":"renamed"}',
])("a text that is not a frame is ignored: %s", (text) => {
  expect(parse(text)).toBeNull();
});

test("binary messages are ignored", () => {
  expect(parse(new ArrayBuffer(2))).toBeNull();
});
