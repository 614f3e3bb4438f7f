import "./style.css";
import { App } from "./app";
import { h } from "./panels/dom";

/** Whatever goes wrong here is said, never a blank page. */
function fail(error: unknown): void {
  const text = error instanceof Error ? error.message : String(error);
  const card = h("div", { class: "card", role: "alertdialog", "aria-label": "The page has failed" }, h("h2", {}, "The page has failed"), h("p", {}, text));
  const reload = h("button", { type: "button", class: "primary", onclick: () => location.reload() }, "Reload");
  card.append(reload);
  document.body.append(card);
}

addEventListener("error", (event) => fail(event.error ?? event.message), { once: true });
addEventListener("unhandledrejection", (event) => fail(event.reason), { once: true });

try {
  new App(document.body).start();
} catch (error) {
  fail(error);
}
