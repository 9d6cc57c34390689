// Raveboard.
import { page } from "./vite.page.ts";

export default page("board", "board/page");
