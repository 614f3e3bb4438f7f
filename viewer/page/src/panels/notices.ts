/**
 * Notices that disappear, warnings that stay, and the card that replaces the view when there is nothing to
 * show.
 */
import type { Status } from "../client";
import { h } from "./dom";

const NOTICE_MILLISECONDS = 9000;

const MOST_NOTICES = 4;

export class Notices {
  readonly element: HTMLElement;
  private readonly lasting = h("div");
  private readonly passing = h("div");
  /** Current warnings of the scene and their elements, until dismissed. */
  private warnings = new Map<string, HTMLElement>();

  constructor() {
    this.element = h("div", { class: "notices", role: "log", "aria-live": "polite", "aria-label": "Messages" }, this.lasting, this.passing);
  }

  show(text: string): void {
    const shown = [...this.passing.children].find((child) => child.firstChild?.textContent === text);
    if (shown) return;
    const notice = this.notice(text);
    this.passing.append(notice);
    while (this.passing.children.length > MOST_NOTICES) this.passing.firstChild!.remove();
    setTimeout(() => notice.remove(), NOTICE_MILLISECONDS);
  }

  /**
   * Sets the current warnings. Each stays until it is dismissed or no longer applies, and does not reappear
   * meanwhile.
   */
  warn(texts: string[]): void {
    const now = new Map(texts.map((text) => [text, this.warnings.get(text) ?? this.notice(text)]));
    for (const [text, element] of now) if (!this.warnings.has(text)) this.lasting.append(element);
    for (const [text, element] of this.warnings) if (!now.has(text)) element.remove();
    this.warnings = now;
  }

  private notice(text: string): HTMLElement {
    const notice = h("div", { class: "notice" }, h("span", {}, text));
    notice.append(h("button", { type: "button", class: "text-button", "aria-label": "Dismiss", onclick: () => notice.remove() }, "×"));
    return notice;
  }
}

interface Words {
  title: string;
  text: string;
  again: string;
}

function wordsOf(status: Extract<Status, { state: "ended" }>, carriesLibrary: boolean): Words {
  const { reason, detail } = status;
  switch (reason) {
    case "lost":
      return { title: "Connection lost", text: "The program has ended or the network has failed. The page shows the last frame and connects again by itself.", again: "Reconnect now" };
    case "other-token":
      return { title: "The program has another address now", text: "It was started again. Open the address that it prints. With supple view --port and --token-file the address stays the same.", again: "Reconnect" };
    case "crowded":
      return { title: "Too many pages watch", text: "Close another page that watches this session, then try again.", again: "Try again" };
    case "taken-over":
      return { title: "Open in another page", text: "Another page has taken over this session. Only one page at a time can show a session.", again: "Take it back" };
    case "program-ended":
      return { title: "The program has ended", text: "The page shows the last frame. Start it again: with the same port and token file the page connects by itself, otherwise open the address it prints.", again: "Reconnect now" };
    case "refused":
      return { title: "The program rejected a command of this page", text: detail || "Page and program may have different versions. Reload the page.", again: "Reconnect" };
    case "failed":
      return { title: "The session has failed", text: detail || "The program prints details in its terminal.", again: carriesLibrary ? "Start again" : "Reconnect" };
    case "malformed":
      return { title: "The page cannot read a message of the program", text: `${detail} Page and program may have different versions. Reload the page.`, again: "Reconnect" };
    case "too-large":
      return { title: "This scene is too large for the page", text: detail, again: "Try again" };
  }
}

export class Card {
  readonly element = h("div", { class: "card", hidden: true });
  private isFinal = false;

  constructor(private readonly reconnect: () => void, private readonly carriesLibrary: boolean) {}

  showStatus(status: Status): void {
    if (this.isFinal) return;
    if (status.state === "connecting") {
      this.fill("status", "Connecting…", this.carriesLibrary ? "Unpacking the library." : "Waiting for the program.", null);
    } else if (status.state === "connected") {
      this.fill("status", "Connected", "Waiting for the scene.", null);
    } else {
      const { title, text, again } = wordsOf(status, this.carriesLibrary);
      this.fill("alertdialog", title, text, h("button", { type: "button", class: "primary", onclick: this.reconnect }, again));
    }
  }

  /** For failures that a new connection does not solve. */
  fail(title: string, text: string): void {
    this.fill("alertdialog", title, text, h("button", { type: "button", class: "primary", onclick: () => location.reload() }, "Reload"));
    this.isFinal = true;
  }

  hide(): void {
    if (this.isFinal) return;
    this.element.hidden = true;
  }

  private fill(role: string, title: string, text: string, action: HTMLElement | null): void {
    this.element.setAttribute("role", role);
    this.element.setAttribute("aria-label", title);
    this.element.replaceChildren(h("h2", {}, title), h("p", {}, text), ...(action ? [action] : []));
    this.element.hidden = false;
    action?.focus();
  }
}

/** The text for a browser without WebGL 2. */
export function cannotDraw(error: unknown): string {
  const why = error instanceof Error ? error.message : String(error);
  return `WebGL 2 is not available (${why}). Enable hardware acceleration, or use another browser.`;
}
