import { mount } from "svelte";
import "../lib/theme.css";
import "./round.css";
import Chat from "./Chat.svelte";

const target = document.getElementById("page");
if (target !== null) mount(Chat, { target });
