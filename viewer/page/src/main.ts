import "./styles/page.css";
import "./styles/controls.css";
import "./styles/bars.css";
import "./styles/scene.css";
import "./styles/details.css";
import "./styles/messages.css";
import "./styles/program.css";
import "./styles/fields.css";
import "./styles/look.css";
import "./styles/narrow.css";  // the last one, because it changes the layout of the others
import { App } from "./app";
import { h } from "./panels/dom";

const app = new App(document.body);

/** Shows any error, so that the page is never blank. */
function fail(error: unknown): void {
  const text = error instanceof Error ? error.message : String(error);
  app.fail(text);
  const card = h("div", { class: "card", role: "alertdialog", "aria-label": "The page has failed" }, h("h2", {}, "The page has failed"), h("p", {}, text));
  const reload = h("button", { type: "button", class: "primary", onclick: () => location.reload() }, "Reload");
  card.append(reload);
  document.body.append(card);
}

let hasFailed = false;
function failOnce(error: unknown): void {
  if (!hasFailed) fail(error);
  hasFailed = true;
}

addEventListener("error", (event) => {
  if (event.error) failOnce(event.error);  // without `error` it is only a notice of the browser, for example about layout
});
addEventListener("unhandledrejection", (event) => failOnce(event.reason));

try {
  app.start();
} catch (error) {
  failOnce(error);
}
