/** Layers over the surfaces, filled from the newest frame while switched on. */
import * as THREE from "three";
import { GAPS, gapLevel, MARKS } from "../colours";
import { selectableIn, shareOfMargins } from "../contacts";
import { dotColours, fillArrows, fillDots } from "../fields/marks";
import { boundsOf } from "../bounds";
import type { Model, ObjectState } from "../model";
import type { Lists, Rows } from "../protocol/lists";
import { eachElement, eachPlace, numberAt, objectAt, rowsIn, SIDES, vectorAt } from "../records";
import { Dots, Lines, type Projection } from "./marks";
import { Cells, Faces } from "./primitives";
import { drawnAs, styleOf, type Style } from "./styles";

/** In CSS pixels; closer marks are thinned out. */
const SPACING = 13;

/** Writes the three corners of a triangle and returns the offset after them. */
function writeTriangle(into: Float32Array, at: number, object: ObjectState, triangle: number): number {
  for (let corner = 0; corner < 3; ++corner) {
    const from = 3 * object.corners[3 * triangle + corner]!;
    into[at++] = object.positions[from]!;
    into[at++] = object.positions[from + 1]!;
    into[at++] = object.positions[from + 2]!;
  }
  return at;
}

function writeCentroid(into: Float32Array, at: number, object: ObjectState, triangle: number): number {
  for (let axis = 0; axis < 3; ++axis) {
    let sum = 0;
    for (let corner = 0; corner < 3; ++corner)
      sum += object.positions[3 * object.corners[3 * triangle + corner]! + axis]!;
    into[at++] = sum / 3;
  }
  return at;
}

/** Writes the centre of an object's bounds; false when it has none. */
function writeCentre(into: Float32Array, at: number, object: ObjectState): boolean {
  const bounds = boundsOf(object);
  if (!bounds) return false;
  for (let axis = 0; axis < 3; ++axis) into[at + axis] = (bounds.lower[axis]! + bounds.upper[axis]!) / 2;
  return true;
}

/** The triangles at the vertices that the curves at some places enclose: an object and a triangle each. */
function enclosedFaces({ curves, enclosed_vertices }: Lists, at: number[], objects: ObjectState[]): number[] {
  const enclosed = new Map<number, Uint8Array>();  // 1 for each enclosed vertex
  for (const place of at) {
    let from = numberAt(curves, "first_enclosed", place)!;
    for (const side of SIDES) {
      const object = objectAt(curves, side, place);
      if (!enclosed.has(object)) enclosed.set(object, new Uint8Array(objects[object]!.vertices));
      for (const vertex of enclosed_vertices.columns["vertex"]!.subarray(from, (from += numberAt(curves, `enclosed_count_${side}`, place)!))) enclosed.get(object)![vertex] = 1;
    }
  }
  const faces: number[] = [];
  for (const [object, marks] of enclosed) {
    const { corners } = objects[object]!;
    for (let i = 0; i < corners.length; i += 3)
      if (marks[corners[i]!] || marks[corners[i + 1]!] || marks[corners[i + 2]!]) faces.push(object, i / 3);
  }
  return faces;
}

const ARROW_LINES = 5;

/** Writes a shaft and the four edges of its head. */
function writeArrow(into: Float32Array, at: number, start: THREE.Vector3, length: number, along: THREE.Vector3): void {
  const tip = start.clone().addScaledVector(along, length);
  const away = Math.abs(along.x) < 0.6 ? new THREE.Vector3(1, 0, 0) : new THREE.Vector3(0, 1, 0);
  const across = away.cross(along).setLength(0.1 * length);
  const up = along.clone().cross(across);
  const back = tip.clone().addScaledVector(along, -0.25 * length);
  const ends = [start, back.clone().add(across), back.clone().sub(across), back.clone().add(up), back.clone().sub(up)];
  ends.forEach((end, i) => {
    end.toArray(into, at + 6 * i);
    tip.toArray(into, at + 6 * i + 3);
  });
}

/** A set of triangles that can be cleared in constant time. */
class Marks {
  private round = 0;
  private stamps: Uint32Array[] = [];

  fit(objects: ObjectState[]): void {
    this.stamps = objects.map((object) => new Uint32Array(object.triangles));
    this.round = 0;
  }

  begin(): void {
    this.round += 1;
  }

  /** Returns true for the first call with these arguments since the last clear. */
  mark(object: number, triangle: number): boolean {
    const stamps = this.stamps[object]!;
    if (stamps[triangle] === this.round) return false;
    stamps[triangle] = this.round;
    return true;
  }
}

/** The rows of a list whose objects are both visible. */
function shownIn(model: Model, rows: Rows): number[] {
  const shown: number[] = [];
  for (let place = 0; place < rows.count; ++place)
    if (SIDES.every((side) => model.objects[objectAt(rows, side, place)]?.visible)) shown.push(place);
  return shown;
}

/** Calls `visit` with each contact point whose objects are both visible: its array and offset, and its row. */
export function eachContactPoint(model: Model, visit: (data: ArrayLike<number>, at: number, rows: Rows, place: number) => void): void {
  const { frame, objects } = model;
  for (const list of frame ? drawnAs("contact") : []) {
    const rows: Rows = frame!.lists[list];
    for (const place of shownIn(model, rows)) eachPlace(rows, place, frame!.lists, objects, (data, at) => visit(data, at, rows, place));
  }
}

/** The same for each segment of a contact, with the offsets of both ends. */
export function eachContactSegment(model: Model, visit: (data: ArrayLike<number>, from: number, to: number) => void): void {
  const lists = model.frame?.lists;
  if (!lists) return;
  for (const place of shownIn(model, lists.contacts)) {
    const { first, end } = rowsIn(lists.contacts, place, "contact_points", lists);
    const count = end - first;
    const lines = count === 2 ? 1 : count > 2 ? count : 0;  // a polygon is closed
    for (let k = 0; k < lines; ++k) visit(lists.contact_points.columns["position"]!, 3 * (first + k), 3 * (first + ((k + 1) % count)));
  }
}

export class Layers {
  readonly group = new THREE.Group();
  readonly regions = new Cells("boxes", { colour: "#ffffff", opacity: 0.85 });
  readonly boxes = new Cells("boxes", { colour: "#ffffff", opacity: 0.9 });
  readonly balls = new Cells("balls", { colour: "#ffffff", opacity: 0.8 });
  readonly nodeBoxes = new Cells("boxes", { colour: "#ffffff", opacity: 1, order: 2 });
  readonly nodeBalls = new Cells("balls", { colour: "#ffffff", opacity: 1, order: 2 });
  readonly edges = new Cells("edges", { colour: "#ffffff", opacity: 0.9 });
  readonly nodeEdges = new Cells("edges", { colour: "#ffffff", opacity: 1, order: 2 });
  readonly pairs = new Lines({ colour: MARKS.pair, size: 3, onTop: true, order: 4 });
  readonly candidateFaces = new Faces({ colour: MARKS.candidate, opacity: 0.4, order: 1 });
  readonly candidates = new Lines({ colour: MARKS.candidate, size: 1.5, onTop: true, order: 3 });
  readonly triangles = new Faces({ colour: MARKS.contact, opacity: 0.7, order: 2 });
  readonly points = new Dots({ colour: MARKS.contact, spacing: SPACING, order: 6 });
  readonly normals = new Lines({ colour: MARKS.normal, size: 2, spacing: SPACING, order: 5 });
  readonly segments = new Lines({ colour: MARKS.contact, size: 2.5, order: 5 });
  readonly gapLines = new Lines({ colour: "", colours: GAPS, size: 2, spacing: SPACING, order: 4 });
  readonly gaps = new Dots({ colour: "", colours: GAPS, ring: true, spacing: SPACING, order: 6 });
  readonly depths = new Lines({ colour: MARKS.depth, size: 2.5, spacing: SPACING, order: 5 });
  readonly depthPoints = new Dots({ colour: MARKS.depth, spacing: SPACING, order: 6 });
  readonly curveFaces = new Faces({ colour: MARKS.curve, opacity: 0.4, order: 1 });
  readonly curveArrows = new Lines({ colour: MARKS.curve, size: 3.5, order: 6 });
  readonly curves = new Dots({ colour: MARKS.curve, order: 7 });
  readonly vertices = new Dots({ colour: MARKS.vertex, spacing: SPACING / 2, order: 6 });
  readonly fieldArrows = new Lines({ colour: MARKS.vector, size: 1.5, arrow: true, spacing: 2 * SPACING, order: 7 });
  readonly fieldDots = new Dots({ colour: "", colours: dotColours("viridis"), spacing: SPACING, order: 8 });
  private readonly marks = new Marks();

  constructor(private readonly model: Model) {
    for (const layer of Object.values({ ...this.primitives, ...this.sized })) this.group.add(layer.shape);
    model.on("scene", () => this.marks.fit(model.objects));
  }

  private get primitives() {
    const { regions, boxes, balls, edges, nodeBoxes, nodeBalls, nodeEdges, candidateFaces, triangles, curveFaces } = this;
    return { regions, boxes, balls, edges, nodeBoxes, nodeBalls, nodeEdges, candidateFaces, triangles, curveFaces };
  }

  private get sized() {
    const { pairs, candidates, points, normals, segments, gapLines, gaps, depths, depthPoints, curveArrows, curves, vertices, fieldArrows, fieldDots } = this;
    return { pairs, candidates, points, normals, segments, gapLines, gaps, depths, depthPoints, curveArrows, curves, vertices, fieldArrows, fieldDots };
  }

  /** The number of elements of each layer, also of those that are thinned out. */
  counts(): Record<string, number> {
    const layers = drawnAs("gaps").map((list) => [styleOf(list).layer, this.gaps] as const);
    return Object.fromEntries([...Object.entries({ ...this.primitives, ...this.sized }), ...layers].map(([name, { count }]) => [name, count]));
  }

  /** Call before each drawing. */
  arrange(projection: Projection): void {
    for (const marks of Object.values(this.sized)) marks.arrange(projection);
  }

  update(): void {
    const { layers } = this.model;
    const { throughSurfaces, pointSize } = this.model;
    for (const cells of [this.nodeBoxes, this.nodeBalls, this.nodeEdges, this.curveFaces]) cells.depthTest = !throughSurfaces;
    for (const marks of Object.values(this.sized)) marks.through = throughSurfaces;
    this.points.size = this.depthPoints.size = pointSize + 2;
    this.gaps.size = this.curves.size = pointSize + 4;
    this.vertices.size = pointSize;
    this.normals.span = this.model.normalLength;
    this.fillCells();
    this.fillPairs(layers.pairs);
    this.fillCandidates(layers.candidates);
    this.fillTriangles(layers.triangles);
    this.fillPoints(this.points, layers.points);
    this.fillPoints(this.normals, layers.normals);
    this.fillSegments(layers.segments);
    this.fillGaps();
    this.fillDepths();
    this.fillCurves(layers.curves);
    this.fillVertices(layers.vertices);
    fillArrows(this.fieldArrows, this.model);
    fillDots(this.fieldDots, this.model);
  }

  private shown(object: number): boolean {
    return this.model.objects[object]?.visible ?? false;
  }

  private fillCells(): void {
    const { frame, layers } = this.model;
    const ofShown = (on: boolean, cells: Map<number, Float32Array> | undefined) =>
      on && cells ? [...cells].filter(([object]) => this.shown(object)).map(([, data]) => data) : [];
    this.regions.fill(layers.regions && frame ? [frame.sceneRegions] : []);
    this.boxes.fill(ofShown(layers.octree, frame?.octreeBoxes));
    this.balls.fill(ofShown(layers.octree, frame?.octreeSpheres));
    this.edges.fill(ofShown(layers.octree, frame?.octreeEdges));
    this.nodeBoxes.fill(ofShown(layers.nodes, frame?.collidingBoxes));
    this.nodeBalls.fill(ofShown(layers.nodes, frame?.collidingSpheres));
    this.nodeEdges.fill(ofShown(layers.nodes, frame?.collidingEdges));
  }

  private fillPairs(on: boolean): void {
    const { frame, objects } = this.model;
    const pairs = on && frame ? shownIn(this.model, frame.lists.object_pairs) : [];
    this.pairs.fill(pairs.length, (into) => {
      let at = 0;
      for (const place of pairs) {
        const [a, b] = SIDES.map((side) => objects[objectAt(frame!.lists.object_pairs, side, place)]!);
        if (writeCentre(into, at, a!) && writeCentre(into, at + 3, b!)) at += 6;
      }
      return at / 6;
    });
  }

  private fillCandidates(on: boolean): void {
    const pairs = on ? this.model.frame?.candidates : undefined;
    const objects = this.model.objects;
    const count = pairs ? pairs.length / 4 : 0;
    this.candidates.fill(count, (into) => {
      let at = 0;
      for (let i = 0; i < pairs!.length; i += 4) {
        if (!this.shown(pairs![i]!) || !this.shown(pairs![i + 2]!)) continue;
        at = writeCentroid(into, at, objects[pairs![i]!]!, pairs![i + 1]!);
        at = writeCentroid(into, at, objects[pairs![i + 2]!]!, pairs![i + 3]!);
      }
      return at / 6;
    });
    this.fillFaces(this.candidateFaces, 2 * count, (visit) => {
      for (let i = 0; i < 4 * count; i += 2) visit(pairs![i]!, pairs![i + 1]!);
    });
  }

  /** Fills triangles, at most this many, each once. */
  private fillFaces(faces: Faces, most: number, each: (visit: (object: number, triangle: number) => void) => void): void {
    this.marks.begin();
    faces.fill(most, (into) => {
      let at = 0;
      each((object, triangle) => {
        if (this.shown(object) && this.marks.mark(object, triangle)) at = writeTriangle(into, at, this.model.objects[object]!, triangle);
      });
      return at / 9;
    });
  }

  private fillTriangles(on: boolean): void {
    const { frame } = this.model;
    const rows = on && frame ? selectableIn(frame) : null;
    this.fillFaces(this.triangles, 2 * (rows?.count ?? 0), (visit) => {
      for (const side of SIDES) eachElement(rows!, side, (object, kind, face) => kind === "face" && visit(object, face));
    });
  }

  /** A mark at each contact point; that of a line has the normal, too. */
  private fillPoints(marks: Dots | Lines, on: boolean): void {
    let count = 0;
    if (on) eachContactPoint(this.model, () => (count += 1));
    marks.fill(count, (into) => {
      let at = 0;
      eachContactPoint(this.model, (data, from, { columns }, place) => {
        for (let axis = 0; axis < 3; ++axis) into[at++] = data[from + axis]!;
        if (marks instanceof Lines) for (let axis = 0; axis < 3; ++axis) into[at++] = columns["normal"]?.[3 * place + axis] ?? 0;
      });
      return count;
    });
  }

  private fillSegments(on: boolean): void {
    this.segments.fill(on && this.model.frame ? this.model.frame.lists.contact_points.count : 0, (into) => {
      let at = 0;
      eachContactSegment(this.model, (data, from, to) => {
        for (const end of [from, to]) for (let axis = 0; axis < 3; ++axis) into[at++] = data[end + axis]!;
      });
      return at / 6;
    });
  }

  /** The rows of lists that are drawn like this, in visible layers and of visible objects. */
  private drawn(draws: Style["draws"]): { rows: Rows; place: number }[] {
    const { frame, layers } = this.model;
    const lists = frame ? drawnAs(draws).filter((list) => layers[styleOf(list).layer]) : [];
    return lists.map((list): Rows => frame!.lists[list]).flatMap((rows) => shownIn(this.model, rows).map((place) => ({ rows, place })));
  }

  /** Writes the points of a row, and returns the offset after them. */
  private writePoints(into: Float32Array, at: number, { rows, place }: { rows: Rows; place: number }): number {
    eachPlace(rows, place, this.model.frame!.lists, this.model.objects, (data, from) => {
      for (let axis = 0; axis < 3; ++axis) into[at++] = data[from + axis]!;
    });
    return at;
  }

  /** A ring in the middle of each gap, and a line as long as the gap, coloured by the share of the margins. */
  private fillGaps(): void {
    const gaps = this.drawn("gaps");
    const levels = gaps.map(({ rows, place }) => gapLevel(shareOfMargins(this.model.scene!, rows, place)));
    this.gapLines.fill(gaps.length, (into) => {
      gaps.forEach((gap, k) => (into[this.writePoints(into, 7 * k, gap)] = levels[k]!));
      return gaps.length;
    });
    const ends = new Float32Array(6);
    this.gaps.fill(gaps.length, (into) => {
      gaps.forEach((gap, k) => {
        this.writePoints(ends, 0, gap);
        for (let axis = 0; axis < 3; ++axis) into[4 * k + axis] = (ends[axis]! + ends[3 + axis]!) / 2;
        into[4 * k + 3] = levels[k]!;
      });
      return gaps.length;
    });
  }

  /** Lines from the vertices inside solid objects to the closest points of their surfaces. */
  private fillDepths(): void {
    const depths = this.drawn("depths");
    this.depths.fill(depths.length, (into) => {
      depths.forEach((depth, k) => this.writePoints(into, 6 * k, depth));
      return depths.length;
    });
    const ends = new Float32Array(6);
    this.depthPoints.fill(depths.length, (into) => {
      depths.forEach((depth, k) => {
        this.writePoints(ends, 0, depth);
        into.set(ends.subarray(0, 3), 3 * k);
      });
      return depths.length;
    });
  }

  /** The triangles at the vertices that each curve encloses, and an arrow along its normal, as long as its depth. */
  private fillCurves(on: boolean): void {
    const { frame, objects } = this.model;
    const shown = on && frame ? shownIn(this.model, frame.lists.curves) : [];
    const faces = frame ? enclosedFaces(frame.lists, shown, objects) : [];
    this.curveFaces.fill(faces.length / 2, (into) => {
      let at = 0;
      for (let i = 0; i < faces.length; i += 2) at = writeTriangle(into, at, objects[faces[i]!]!, faces[i + 1]!);
      return at / 9;
    });
    this.curves.fill(shown.length, (into) => {
      shown.forEach((place, k) => into.set(vectorAt(frame!.lists.curves, "centroid", place), 3 * k));
      return shown.length;
    });
    this.curveArrows.fill(ARROW_LINES * shown.length, (into) => {
      shown.forEach((place, k) => {
        const [start, along] = ["centroid", "normal"].map((name) => new THREE.Vector3().fromArray(vectorAt(frame!.lists.curves, name, place)));
        writeArrow(into, 6 * ARROW_LINES * k, start!, numberAt(frame!.lists.curves, "depth", place)!, along!);
      });
      return ARROW_LINES * shown.length;
    });
  }

  private fillVertices(on: boolean): void {
    const groups = on && this.model.frame ? this.model.frame.collidingVertices : new Map<number, Uint32Array>();
    let count = 0;
    for (const vertices of groups.values()) count += vertices.length;
    this.vertices.fill(count, (into) => {
      let at = 0;
      for (const [index, vertices] of groups) {
        if (!this.shown(index)) continue;
        const { positions } = this.model.objects[index]!;
        for (const vertex of vertices)
          for (let axis = 0; axis < 3; ++axis) into[at++] = positions[3 * vertex + axis]!;
      }
      return at / 3;
    });
  }
}
