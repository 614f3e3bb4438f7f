/** The header and the filter of a table: what sorts its rows, and which of them it lists. */
import { readFilter, sortRows, type Column, type Sorting } from "../../filter";
import { h } from "../dom";

let tables = 0;

export class TableControls<Row> {
  /** The field for the filter. */
  readonly field: HTMLInputElement;
  /** Why the filter cannot be read. */
  readonly refusal = h("p", { class: "refusal", role: "status", hidden: true });
  readonly head: HTMLElement;
  private readonly heads: HTMLElement[];
  private sorting: Sorting | null = null;
  private readonly shown: Column<Row>[];

  /** `numbers` are the keys of columns with numbers; `label` says what the table lists; `grid` gets the header, which is outside of its box that scrolls. */
  constructor(private readonly columns: Column<Row>[], private readonly numbers: string[], label: string, private readonly grid: HTMLElement | null, private readonly changed: () => void) {
    const id = `table-${++tables}`;
    this.shown = columns.filter((column) => column.label !== undefined);
    const example = numbers[0] ? `${numbers[0]}>2` : "";
    this.field = h("input", {
      type: "search", placeholder: `Filter: name${example ? `, ${example}` : ""}`, "aria-label": `Filter ${label}`, "aria-describedby": `${id}-refusal`,
      title: `Words of a name, and conditions with < <= > >= = != for ${columns.map(({ key }) => key).join(", ")}; all must hold`, oninput: () => changed(),
    });
    this.refusal.id = `${id}-refusal`;
    this.heads = this.shown.map(({ label: name, title }, i) => {
      const button = h("button", { type: "button", title: `${title ?? ""} (sort)`.trim(), "aria-label": `Sort by ${name}`, onclick: () => this.sortBy(i) }, name!);
      return h("span", { role: grid && "columnheader" }, button);
    });
    this.head = h("div", { class: "row head", role: grid ? "row" : "group", "aria-label": grid ? null : `Order of ${label}`, id: `${id}-head` }, ...this.heads);
    grid?.setAttribute("aria-owns", this.head.id);
    this.showSorting();
  }

  get isFiltered(): boolean {
    return this.field.value.trim() !== "";
  }

  /** The rows that are listed, in their order. A filter that cannot be read lists all. */
  apply(rows: Row[]): Row[] {
    const filter = this.isFiltered ? readFilter(this.field.value, this.columns, ({ key }) => this.numbers.includes(key)) : { accepts: () => true };
    const error = "error" in filter ? filter.error : "";
    if (this.refusal.textContent !== error) this.refusal.textContent = error;
    this.refusal.hidden = error === "";
    this.field.setAttribute("aria-invalid", String(error !== ""));
    const listed = "error" in filter || !this.isFiltered ? rows : rows.filter((row) => filter.accepts(row));
    return this.sorting ? sortRows(listed, this.shown[this.sorting.column]!, this.sorting.reversed) : listed;
  }

  /** The first click sorts, the second reverses, the third restores the first order. */
  private sortBy(column: number): void {
    const { sorting } = this;
    if (sorting?.column !== column) this.sorting = { column, reversed: false };
    else this.sorting = sorting.reversed ? null : { column, reversed: true };
    this.showSorting();
    this.changed();
  }

  private showSorting(): void {
    this.heads.forEach((head, i) => {
      const isReversed = this.sorting?.column === i ? this.sorting.reversed : null;
      const { key, rank } = this.shown[i]!;
      const ascends = this.numbers.includes(key) || rank ? isReversed : isReversed === false;
      head.dataset["sort"] = isReversed === null ? "none" : ascends ? "ascending" : "descending";
      if (this.grid) head.setAttribute("aria-sort", head.dataset["sort"]);
      else head.firstElementChild!.setAttribute("aria-pressed", String(isReversed !== null));
    });
  }
}
