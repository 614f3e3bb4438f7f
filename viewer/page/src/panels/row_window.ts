/** Rows in a box that scrolls, as many as there are: only those in sight have elements. */
import { h } from "./dom";

/** Browsers give up on elements that are higher than this. */
const HIGHEST = 8_000_000;

/** Which rows are in sight. Of more rows than fit a scroll bar, it moves more than a pixel a pixel. All lengths in pixels. */
export class RowScale {
  /** Of what scrolls within the box. */
  readonly scrollHeight: number;
  private readonly ratio: number;

  constructor(readonly count: number, readonly rowHeight: number, readonly boxHeight: number) {
    const high = count * rowHeight;
    this.scrollHeight = Math.min(HIGHEST, high);
    this.ratio = high > HIGHEST ? (high - boxHeight) / (HIGHEST - boxHeight) : 1;
  }

  /** The first row in sight, how many there are from it on, and where the first one stands in what scrolls. */
  inSight(scrollTop: number): { first: number; shown: number; top: number } {
    const above = Math.max(0, scrollTop) * this.ratio;
    const first = Math.max(0, Math.min(Math.floor(above / this.rowHeight), this.count - 1));
    const shown = Math.min(Math.ceil(this.boxHeight / this.rowHeight) + 1, this.count - first);
    return { first, shown, top: scrollTop - (above - first * this.rowHeight) };
  }

  /** Where to scroll to so that a row is in sight, which is as little as is needed. */
  scrollTo(row: number, scrollTop: number): number {
    const above = scrollTop * this.ratio;
    const slack = Math.ceil(this.ratio) - 1;  // scroll bars stand at whole pixels
    const top = row * this.rowHeight;
    const bottom = top + this.rowHeight - this.boxHeight;
    if (top < above) return Math.max(0, top - slack) / this.ratio;
    return bottom > above ? (bottom + slack) / this.ratio : scrollTop;
  }
}

/** An element that shows one row, then another. */
export interface Row {
  readonly element: HTMLElement;
  show(index: number): void;
}

export class RowWindow<Kind extends Row> {
  /** The box that scrolls. */
  readonly element: HTMLElement;
  private readonly spacer: HTMLElement;
  private rows: Kind[] = [];
  private count = 0;
  private first = 0;

  constructor(
    attributes: Parameters<typeof h>[1], private readonly body: HTMLElement, private readonly rowHeight: number, private readonly makeRow: () => Kind,
  ) {
    this.spacer = h("div", { class: "spacer" }, body);
    this.element = h("div", { ...attributes, onscroll: () => this.draw() }, this.spacer);
    new ResizeObserver(() => this.draw()).observe(this.element);
  }

  private get scale(): RowScale {
    return new RowScale(this.count, this.rowHeight, this.element.clientHeight);
  }

  setCount(count: number): void {
    this.count = count;
    this.spacer.style.height = `${this.scale.scrollHeight}px`;
    this.draw();
  }

  /** Shows the rows in sight anew. */
  draw(): void {
    const { scale } = this;
    if (scale.boxHeight === 0) return;  // it is not shown
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

  /** Rows that stay in sight keep their elements, so that who types or drags in one of them is not disturbed. */
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

  /** What shows a row that is in sight. */
  rowOf(index: number): Kind | undefined {
    return index < this.count ? this.rows[index - this.first] : undefined;
  }

  reveal(index: number): void {
    const { scrollTop } = this.element;
    const wanted = this.scale.scrollTo(index, scrollTop);
    if (wanted === scrollTop) return;
    this.element.scrollTop = wanted;
    this.draw();
  }

  /** The row that a key leads to from another one, −1 for none; null where it leads nowhere. */
  rowAfter(key: string, now: number): number | null {
    const page = Math.max(1, Math.floor(this.element.clientHeight / this.rowHeight) - 1);
    const steps: Record<string, number> = { ArrowDown: 1, ArrowUp: -1, PageDown: page, PageUp: -page, Home: -Infinity, End: Infinity };
    const step = steps[key];
    if (step === undefined || this.count === 0) return null;
    const next = now < 0 && Number.isFinite(step) ? 0 : now + step;
    return Math.max(0, Math.min(this.count - 1, next));
  }
}
