/** The marks of a field: arrows for vectors, coloured dots for contacts. */
import { pointsOf } from "../contacts";
import type { Model } from "../model";
import type { Rows } from "../protocol/lists";
import { objectAt, SIDES } from "../records";
import type { Dots, Lines } from "../view/marks";
import { colourAt, type MapName } from "./colour_maps";
import { rangeOf, readField } from "./fields";

/** The colours of dots. A shader has room for so many. */
export const DOT_COLOURS = 64;

export const dotColours = (map: MapName): string[] =>
  Array.from({ length: DOT_COLOURS }, (_, i) => `rgb(${colourAt(map, i / (DOT_COLOURS - 1)).join(",")})`);

/** Shorter arrows than this part of the longest one are left out. */
const SHORTEST = 0.02;

/** An arrow at each vertex, or in the middle of each triangle. */
export function fillArrows(arrows: Lines, model: Model): void {
  const data = readField(model);
  const shown = data?.form.vector ? [...data.vectors].filter(([object]) => model.objects[object]!.visible) : [];
  const longest = data ? rangeOf(data, { ...model.field, map: "viridis" })[1] : 0;
  const most = longest > 0 ? shown.reduce((sum, [, vectors]) => sum + vectors.length / 3, 0) : 0;
  arrows.span = model.field.arrowLength;
  arrows.fill(most, (into) => {
    let at = 0;
    for (const [object, vectors] of shown) {
      const { positions, corners } = model.objects[object]!;
      const lengths = data!.values.get(object)!;
      for (let i = 0; i < lengths.length; ++i) {
        if (!(lengths[i]! >= SHORTEST * longest)) continue;
        for (let axis = 0; axis < 3; ++axis) {
          const corner = (k: number) => positions[3 * corners[3 * i + k]! + axis]!;
          into[at + axis] = data!.form.element === "face" ? (corner(0) + corner(1) + corner(2)) / 3 : positions[3 * i + axis]!;
          into[at + 3 + axis] = vectors[3 * i + axis]! / longest;
        }
        at += 6;
      }
    }
    return at / 6;
  });
}

const coloured = new WeakMap<Dots, MapName>();

/** A dot at each contact. */
export function fillDots(dots: Dots, model: Model): void {
  if (coloured.get(dots) !== model.field.map) dots.colours = dotColours(model.field.map);
  coloured.set(dots, model.field.map);
  const data = readField(model);
  const { frame, objects } = model;
  const rows: Rows | null = data?.form.list && frame ? frame.lists[data.form.list] : null;
  const [low, high] = data ? rangeOf(data, model.field) : [0, 0];
  dots.size = model.pointSize + 6;
  dots.fill(rows?.count ?? 0, (into) => {
    let count = 0;
    for (let place = 0; place < rows!.count; ++place) {
      const value = data!.ofRows[place]!;
      if (!Number.isFinite(value) || !SIDES.every((side) => objects[objectAt(rows!, side, place)]!.visible)) continue;
      into.set(pointsOf(frame!, objects, rows!, place)[0]!, 4 * count);
      into[4 * count + 3] = Math.round((DOT_COLOURS - 1) * (high > low ? Math.max(0, Math.min(1, (value - low) / (high - low))) : 0));
      count += 1;
    }
    return count;
  });
}
