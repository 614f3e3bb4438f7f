/** A virtual list: only visible rows have elements. */
import { h, remPixels } from "../dom";

/** Browsers do not lay out elements higher than this. */
const HIGHEST = 8_000_000;

/**
 * Maps scroll positions to rows. When the rows exceed the maximum height, one pixel of scrolling moves more
 * than one pixel of rows. All lengths are in pixels.
 */
export class RowScale {
  /** The height of the scrolled content. */
  readonly scrollHeight: number;
  private readonly ratio: number;

  constructor(readonly count: number, readonly rowHeight: number, readonly boxHeight: number) {
    const high = count * rowHeight;
    this.scrollHeight = Math.min(HIGHEST, high);
    this.ratio = high > HIGHEST ? (high - boxHeight) / (HIGHEST - boxHeight) : 1;
  }

  /** The first visible row, the number of visible rows, and the position of the first one in the content. */
  inSight(scrollTop: number): { first: number; shown: number; top: number } {
    const above = Math.max(0, scrollTop) * this.ratio;
    const first = Math.max(0, Math.min(Math.floor(above / this.rowHeight), this.count - 1));
    const shown = Math.min(Math.ceil(this.boxHeight / this.rowHeight) + 1, this.count - first);
    return { first, shown, top: scrollTop - (above - first * this.rowHeight) };
  }

  /** The scroll position that makes a row visible with the least movement. */
  scrollTo(row: number, scrollTop: number): number {
    const above = scrollTop * this.ratio;
    const slack = Math.ceil(this.ratio) - 1;  // scroll positions are whole pixels
    const top = row * this.rowHeight;
    const bottom = top + this.rowHeight - this.boxHeight;
    if (top < above) return Math.max(0, top - slack) / this.ratio;
    return bottom > above ? (bottom + slack) / this.ratio : scrollTop;
  }
}

/** An element that shows one row and can be reused for another. */
export interface Row {
  readonly element: HTMLElement;
  show(index: number): void;
}

/** A row of a table. A click chooses it; `fill` writes what it shows into its cells. */
export function makeRow(
  cellCount: number, choose: (index: number) => void, fill: (row: HTMLElement, cells: HTMLElement[], index: number) => void,
): Row {
  const cells = Array.from({ length: cellCount }, () => h("span", { role: "gridcell" }));
  let at = 0;
  const element = h("div", { class: "row", role: "row", onclick: () => choose(at) }, ...cells);
  const show = (index: number) => {
    at = index;
    fill(element, cells, index);
  };
  return { element, show };
}

export class RowWindow<Kind extends Row> {
  /** The scrolling box. */
  readonly element: HTMLElement;
  private readonly spacer: HTMLElement;
  private rows: Kind[] = [];
  private count = 0;
  private first = 0;
  /** The row to scroll to when the list is no longer hidden. */
  private due: number | null = null;

  constructor(
    attributes: Parameters<typeof h>[1], private readonly body: HTMLElement, private readonly rowRems: number, private readonly makeRow: () => Kind,
  ) {
    this.spacer = h("div", { class: "spacer" }, body);
    this.element = h("div", { ...attributes, onscroll: () => this.draw() }, this.spacer);
    new ResizeObserver(() => this.draw()).observe(this.element);
  }

  private get rowHeight(): number {
    return this.rowRems * remPixels();
  }

  private get scale(): RowScale {
    return new RowScale(this.count, this.rowHeight, this.element.clientHeight);
  }

  setCount(count: number): void {
    this.count = count;
    this.spacer.style.height = `${this.scale.scrollHeight}px`;
    this.draw();
  }

  /** Updates the visible rows. */
  draw(): void {
    const { scale } = this;
    if (scale.boxHeight === 0) return;  // the list is hidden
    this.spacer.style.height = `${scale.scrollHeight}px`;  // the font may have changed
    if (this.due !== null) return this.reveal(this.due);
    const { first, shown, top } = scale.inSight(this.element.scrollTop);
    this.moveTo(first);
    while (this.rows.length < shown) {
      const row = this.makeRow();
      this.rows.push(row);
      this.body.append(row.element);
    }
    this.body.style.transform = `translateY(${top}px)`;
    this.rows.forEach((row, i) => {
      row.element.hidden = i >= shown;
      if (i < shown) row.show(first + i);
    });
  }

  /** Rows that stay visible keep their elements, so that typing or dragging in them continues. */
  private moveTo(first: number): void {
    const by = first - this.first;
    if (by === 0) return;
    this.first = first;
    const leaving = by > 0 ? this.rows.splice(0, by) : this.rows.splice(by);
    if (leaving.some(({ element }) => element.contains(document.activeElement))) this.element.focus({ preventScroll: true });
    const elements = leaving.map(({ element }) => element);
    if (by > 0) {
      this.rows.push(...leaving);
      this.body.append(...elements);
    } else {
      this.rows.unshift(...leaving);
      this.body.prepend(...elements);
    }
  }

  /** The element of a visible row. */
  rowOf(index: number): Kind | undefined {
    return index < this.count ? this.rows[index - this.first] : undefined;
  }

  /** Scrolls to a row, as soon as the list is visible. */
  reveal(index: number): void {
    const wasDue = this.due !== null;
    this.due = this.element.clientHeight === 0 ? index : null;
    if (this.due !== null) return;
    const { scrollTop } = this.element;
    const wanted = this.scale.scrollTo(index, scrollTop);
    if (wanted === scrollTop && !wasDue) return;
    this.element.scrollTop = wanted;
    this.draw();
  }

  /** The row that a key leads to from the row `now` (−1 for none); null for other keys. */
  rowAfter(key: string, now: number): number | null {
    const page = Math.max(1, Math.floor(this.element.clientHeight / this.rowHeight) - 1);
    const steps: Record<string, number> = { ArrowDown: 1, ArrowUp: -1, PageDown: page, PageUp: -page, Home: -Infinity, End: Infinity };
    const step = steps[key];
    if (step === undefined || this.count === 0) return null;
    const next = now < 0 && Number.isFinite(step) ? 0 : now + step;
    return Math.max(0, Math.min(this.count - 1, next));
  }
}
