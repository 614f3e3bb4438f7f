/** A view as SVG: outlines, wireframes, contact segments and contact points. Surfaces hide what is behind them. */
import { MARKS } from "../colours";
import type { Model, ObjectState } from "../model";
import { eachContactPoint, eachContactSegment } from "../view/layers";
import { DepthBuffer, edgesOf, outlineOf, project, visibleParts, type Projected } from "./lines";
import { short, svgFile, svgPen, type Pen, type Sheet } from "./pen";

/** Lines are hidden to a pixel of a buffer of this size. */
const BUFFER_SIDE = 2400;
/** Larger files open slowly or not at all. */
const MOST_LINES = 400_000;

/** In CSS pixels. */
const WIDTHS = { outline: 1.2, wireframe: 0.5, segment: 1.6 };

export interface SvgPlan extends Sheet {
  /** The colour of the background; null for none. */
  ground: string | null;
  ink: string;
  /** Whether outlines have the colours of the objects, as a legend shows them. */
  usesColours: boolean;
  /** From positions to clip space, in columns. */
  matrix: ArrayLike<number>;
}

class Drawing {
  readonly parts: string[] = [];
  private lines = 0;
  private readonly buffer: DepthBuffer | null;
  private readonly scale: number;

  constructor(private readonly model: Model, private readonly plan: SvgPlan, private readonly places: Map<ObjectState, Projected>) {
    this.scale = BUFFER_SIDE / Math.max(plan.width, plan.height);
    const solids = model.layers.surface && !model.xray ? [...places].filter(([{ opacity }]) => opacity === 1) : [];
    this.buffer = solids.length > 0 ? new DepthBuffer(Math.ceil(plan.width * this.scale), Math.ceil(plan.height * this.scale)) : null;
    for (const [{ corners }, at] of solids) this.buffer!.add(at, corners, this.scale);
  }

  private path(pieces: string[], colour: string, width: number): void {
    if (pieces.length > 0) this.parts.push(`<path d="${pieces.join("")}" stroke="${colour}" stroke-width="${width}" fill="none" stroke-linecap="round"/>`);
  }

  private line(pieces: string[], from: [number, number, number], to: [number, number, number], buffer: DepthBuffer | null): void {
    for (const [x, y, toX, toY] of visibleParts(from, to, buffer, this.scale)) {
      pieces.push(`M${short(x)} ${short(y)}L${short(toX)} ${short(toY)}`);
      if (++this.lines > MOST_LINES) throw new Error(`The SVG would have more than ${MOST_LINES} lines. Switch the wireframe off, hide objects, or choose PNG.`);
    }
  }

  /** All edges with the layer Wireframe, else the outline of a surface. */
  edges(object: ObjectState): void {
    const { layers } = this.model;
    if (!layers.surface && !layers.wireframe) return;
    const at = this.places.get(object)!;
    const all = edgesOf(object.corners);
    const wanted = layers.wireframe ? all : outlineOf(all, object.positions, object.corners, at);
    const pieces: string[] = [];
    const end = (vertex: number): [number, number, number] => [at[3 * vertex]!, at[3 * vertex + 1]!, at[3 * vertex + 2]!];
    for (let i = 0; i < wanted.length; i += 4) this.line(pieces, end(wanted[i]!), end(wanted[i + 1]!), this.buffer);
    this.path(pieces, layers.surface && !this.plan.usesColours ? this.plan.ink : object.colour, layers.wireframe ? WIDTHS.wireframe : WIDTHS.outline);
  }

  marks(): void {
    const { model, plan } = this;
    const buffer = model.throughSurfaces ? null : this.buffer;
    const place = (data: ArrayLike<number>, from: number) => project([data[from]!, data[from + 1]!, data[from + 2]!], plan.matrix, plan.width, plan.height) as unknown as [number, number, number];
    if (model.layers.segments) {
      const pieces: string[] = [];
      eachContactSegment(model, (data, from, to) => this.line(pieces, place(data, from), place(data, to), buffer));
      this.path(pieces, MARKS.contact, WIDTHS.segment);
    }
    if (!model.layers.points) return;
    eachContactPoint(model, (data, from) => {
      const [x, y, depth] = place(data, from);
      if (Number.isNaN(x) || buffer?.hides(x * this.scale, y * this.scale, depth)) return;
      this.parts.push(`<circle cx="${short(x)}" cy="${short(y)}" r="${model.pointSize / 2}" fill="${MARKS.contact}"/>`);
    });
  }
}

/** `overlay` draws over the lines. Throws with a sentence for a view that lines cannot show. */
export function svgOf(model: Model, plan: SvgPlan, overlay: (pen: Pen) => void): string {
  if (model.slice.axis !== "off") throw new Error("An SVG cannot show a slice. Choose PNG, or no slice.");
  const { width, height, ground } = plan;
  const objects = model.objects.filter(({ visible }) => visible);
  const places = new Map(objects.map((object) => [object, project(object.positions, plan.matrix, width, height)]));
  const drawing = new Drawing(model, plan, places);
  if (ground !== null) drawing.parts.push(`<rect width="${short(width)}" height="${short(height)}" fill="${ground}"/>`);
  for (const object of objects) drawing.edges(object);
  drawing.marks();
  overlay(svgPen(drawing.parts));
  return svgFile(plan, drawing.parts);
}
