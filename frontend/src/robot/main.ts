import { mount } from "svelte";
import "./robot.css";
import App from "./App.svelte";

const target = document.getElementById("page");
if (target !== null) mount(App, { target });
