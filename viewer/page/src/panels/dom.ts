/** Helpers to create elements. */

type Child = Node | string | null;
interface Attributes {
  [name: string]: string | number | boolean | null | undefined | ((event: never) => void);
}

/** Creates an element with attributes, listeners (`onclick`, …) and children. */
export function h<Tag extends keyof HTMLElementTagNameMap>(
  tag: Tag, attributes: Attributes = {}, ...children: Child[]
): HTMLElementTagNameMap[Tag] {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (typeof value === "function") element.addEventListener(name.slice(2), value as unknown as EventListener);
    else if (typeof value === "boolean") element.toggleAttribute(name, value);
    else if (value !== null && value !== undefined) element.setAttribute(name, String(value));
  }
  element.append(...children.filter((child): child is Node | string => child !== null));
  return element;
}

/** Icons are 16 × 16 with a line width of 1.5. */
const ICONS: Record<string, string> = {
  play: '<path d="M4.5 2.8v10.4L13 8z" fill="currentColor"/>',
  pause: '<path d="M5 3v10M11 3v10" stroke-width="2.6"/>',
  forward: '<path d="M3.5 3.5v9l6.5-4.5z" fill="currentColor"/><path d="M12.5 3.5v9"/>',
  back: '<path d="M12.5 3.5v9L6 8z" fill="currentColor"/><path d="M3.5 3.5v9"/>',
  nextEvent: '<path d="M3 4l4 4-4 4M8 4l4 4-4 4"/>',
  previousEvent: '<path d="M13 4L9 8l4 4M8 4L4 8l4 4"/>',
  loop: '<path d="M2.8 7.2A5 5 0 0 1 11.6 5l1.6 1.8M13.2 3v3.8H9.6M13.2 8.8A5 5 0 0 1 4.4 11L2.8 9.2M2.8 13V9.2h3.6"/>',
  reset: '<path d="M3 8a5 5 0 1 0 1.6-3.6L3 6M3 2.6V6h3.4"/>',
  frame: '<path d="M2.5 6V2.5H6M10 2.5h3.5V6M13.5 10v3.5H10M6 13.5H2.5V10"/><circle cx="8" cy="8" r="1.8"/>',
  camera: '<path d="M2 5h3l1.2-1.8h3.6L11 5h3v8H2z"/><circle cx="8" cy="8.8" r="2.2"/>',
  frames: '<path d="M2 6h9v7.5H2zM4 6V4h9v7.5h-2M6 4V2h8.5v7.5H13"/>',
  film: '<path d="M1.8 4.5h8.4v7H1.8zM10.2 7.2l4-2.4v6.4l-4-2.4" fill="currentColor" fill-opacity=".25"/>',
  theme: '<path d="M13.2 9.6A5.6 5.6 0 0 1 6.4 2.8a5.6 5.6 0 1 0 6.8 6.8z"/>',
  select: '<path d="M4 2.2l8.3 6.2-3.7.6 2 4-1.7.8-2-4L4.4 12z"/>',
  grab: '<circle cx="8" cy="8" r="2" fill="currentColor"/><path d="M8 1.8v3M8 11.2v3M1.8 8h3M11.2 8h3"/>',
  explain: '<path d="M1.8 12.5L5 4l2 6zM14.2 12.5L11 4 9 10z"/>',
  ortho: '<path d="M3 5.5h7.5V13H3zM5.5 5.5V3H13v7.5h-2.5"/>',
  perspective: '<path d="M2.5 6h7v7.5h-7zM9.5 6l4-2v6.5l-4 3M2.5 6l4-2h7"/>',
  search: '<circle cx="7" cy="7" r="4.2"/><path d="M10.2 10.2L14 14"/>',
  panes: '<path d="M2 3h12v10H2zM8 3v10M2 8h12"/>',
  panels: '<path d="M2 3h12v10H2z"/><path d="M2 3h4v10H2z" fill="currentColor"/>',
};

export function icon(name: string): SVGSVGElement {
  const holder = document.createElement("template");
  holder.innerHTML =
    `<svg viewBox="0 0 16 16" width="16" height="16" fill="none" stroke="currentColor" stroke-width="1.5" ` +
    `stroke-linecap="round" stroke-linejoin="round" aria-hidden="true">${ICONS[name] ?? ""}</svg>`;
  return holder.content.firstElementChild as SVGSVGElement;
}

/** A button with an icon. The label is its accessible name; the tooltip shows its key. */
export function iconButton(name: string, label: string, key: string, press: () => void): HTMLButtonElement {
  return h("button", { type: "button", class: "icon", "aria-label": label, title: key ? `${label} (${key})` : label, onclick: press }, icon(name));
}

export function setIcon(button: HTMLButtonElement, name: string, label: string, key: string): void {
  button.replaceChildren(icon(name));
  button.setAttribute("aria-label", label);
  button.title = key ? `${label} (${key})` : label;
}

const refills = new WeakMap<HTMLElement, ReturnType<typeof setTimeout>>();

/**
 * Replaces content that changes while a scene plays. The button at the same place gets the focus. While somebody
 * presses a button, it waits: browsers send a click only to a button that stays from the press to the release.
 */
export function refill(element: HTMLElement, ...content: Node[]): void {
  clearTimeout(refills.get(element));
  if (element.matches(":active")) {
    refills.set(element, setTimeout(() => refill(element, ...content), 50));
    return;
  }
  const buttons = () => [...element.querySelectorAll("button")];
  const focused = buttons().indexOf(document.activeElement as HTMLButtonElement);
  element.replaceChildren(...content);
  buttons()[focused]?.focus();
}

/** A dialog with a title and a close button. */
export function sheet(title: string, kind: string, ...children: Child[]): HTMLDialogElement {
  const dialog = h(
    "dialog", { class: kind, "aria-label": title },
    h("header", {}, h("h2", {}, title), h("button", { type: "button", class: "text-button", onclick: () => dialog.close() }, "Close")),
    ...children,
  );
  return dialog;
}

/** A colour of the current theme as `rgb(…)`. */
export function colourOf(name: string): string {
  const probe = h("span", { style: `color: var(${name})` });
  document.body.append(probe);
  const { color } = getComputedStyle(probe);
  probe.remove();
  return color;
}

export function logo(): SVGSVGElement {
  const mark = icon("");
  mark.innerHTML = '<path d="M1 13L6 3l4 10z" fill="#56b4e9" stroke="none"/><path d="M15 13L11 4 6 11z" fill="#d55e00" stroke="none" fill-opacity=".9"/>';
  return mark;
}

/** The size of 1rem, which follows the font size that the user has set in the browser. */
export const remPixels = (): number => parseFloat(getComputedStyle(document.documentElement).fontSize);

/** Formats a number for display. */
export function readable(x: number): string {
  if (!Number.isFinite(x)) return String(x);
  if (Number.isInteger(x)) return x.toLocaleString("en");
  const size = Math.abs(x);
  return size >= 1e-4 && size < 1e6 ? String(Number(x.toPrecision(6))) : x.toExponential(4);
}

/** The current time, for file names. */
export const stamp = (): string => new Date().toISOString().slice(0, 19).replace(/[:T]/g, "-");

export function download(blob: Blob, name: string): void {
  const url = URL.createObjectURL(blob);
  h("a", { href: url, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(url), 10_000);
}
