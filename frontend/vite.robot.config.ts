// The stand-in robot's face.
import { page } from "./vite.page.ts";

export default page("robot", "modules/platform/roboyio/page");
