/** What is below a point of the window, in the pane that is there; and where a point of the scene is in the window. */
import * as THREE from "three";
import { contactCount, hasImpacts, pointsAt } from "../contacts";
import { readField } from "../fields/fields";
import type { Layer, Model } from "../model";
import type { FrameMessage } from "../protocol/messages";
import type { Pane, Panes } from "./panes";
import { pick, type Hit } from "./picking";
import type { Slice } from "./slice";

/** A mark of the newest frame: a row of one of its lists. */
export interface MarkHit {
  kind: "contacts" | "impacts" | "proximity" | "penetrations" | "curves";
  place: number;
}

/** How near the cursor must be, in CSS pixels. */
const REACH = 8;

export class Pointing {
  constructor(private readonly canvas: HTMLElement, private readonly model: Model, private readonly panes: Panes, private readonly slice: Slice) {}

  private boxOf({ area }: Pane): { left: number; top: number; width: number; height: number } {
    const { left, top } = this.canvas.getBoundingClientRect();
    return { left: left + area.left, top: top + area.top, width: area.width, height: area.height };
  }

  private rayAt(pane: Pane, x: number, y: number): THREE.Ray {
    const box = this.boxOf(pane);
    const caster = new THREE.Raycaster();
    const at = new THREE.Vector2(((x - box.left) / box.width) * 2 - 1, 1 - ((y - box.top) / box.height) * 2);
    pane.rig.camera.updateMatrixWorld();
    caster.setFromCamera(at, pane.rig.camera);
    return caster.ray;
  }

  pickAt(x: number, y: number): Hit | null {
    const pane = this.panes.at(x, y);
    const { origin, direction } = this.rayAt(pane, x, y);
    return this.model.inView(pane.index, () => pick({ origin: origin.toArray(), direction: direction.toArray() }, this.model.objects, this.slice.keeps));
  }

  /** The point below the cursor, in the plane through `through` that faces the camera of the active pane. */
  pointAt(x: number, y: number, through: ArrayLike<number>): THREE.Vector3 | null {
    const pane = this.panes.active;
    const normal = pane.rig.camera.getWorldDirection(new THREE.Vector3());
    const plane = new THREE.Plane().setFromNormalAndCoplanarPoint(normal, new THREE.Vector3(through[0], through[1], through[2]));
    return this.rayAt(pane, x, y).intersectPlane(plane, new THREE.Vector3());
  }

  /** The position of a point in the window, in pixels, as the active pane shows it. */
  project(point: ArrayLike<number>): { x: number; y: number } {
    const pane = this.panes.active;
    const box = this.boxOf(pane);
    pane.rig.camera.updateMatrixWorld();
    const at = new THREE.Vector3(point[0], point[1], point[2]).project(pane.rig.camera);
    return { x: box.left + ((at.x + 1) / 2) * box.width, y: box.top + ((1 - at.y) / 2) * box.height };
  }

  /** The index of the contact whose point is closest to the cursor; −1 when none is near. */
  contactAt(x: number, y: number): number {
    return this.nearest(x, y, this.contactPoints())?.place ?? -1;
  }

  /** The mark of a visible layer, or with a value of the shown field, that is closest to the cursor, or null. */
  markAt(x: number, y: number): MarkHit | null {
    return this.nearest(x, y, [...this.contactPoints(), ...this.otherPoints()]);
  }

  private contactPoints(): PointList[] {
    const { frame, layers } = this.model;
    if (!frame || !(layers.points || this.hasField("impact_points"))) return [];
    return hasImpacts(frame) ? [{ kind: "impacts", data: frame.impactPoints, offset: 0 }] : [{ kind: "contacts", data: frame.contactPoints, offset: 0 }];
  }

  /** Whether the shown field has its values in a section. */
  private hasField(section: string): boolean {
    return readField(this.model)?.form.section === section;
  }

  private otherPoints(): PointList[] {
    const { frame, layers } = this.model;
    if (!frame) return [];
    const lists: (PointList & { layer: Layer; section: string })[] = [
      { layer: "proximity", section: "proximity_points", kind: "proximity", data: frame.proximityPoints, offset: 0 },
      { layer: "proximity", section: "proximity_points", kind: "proximity", data: frame.proximityPoints, offset: 4 },
      { layer: "depths", section: "penetration_points", kind: "penetrations", data: frame.penetrationPoints, offset: 0 },
      { layer: "curves", section: "curve_points", kind: "curves", data: frame.curvePoints, offset: 0 },
    ];
    return lists.filter(({ layer, section }) => layers[layer] || this.hasField(section));
  }

  private nearest(x: number, y: number, lists: PointList[]): MarkHit | null {
    const pane = this.panes.at(x, y);
    const box = this.boxOf(pane);
    pane.rig.camera.updateMatrixWorld();
    const matrix = new THREE.Matrix4().multiplyMatrices(pane.rig.camera.projectionMatrix, pane.rig.camera.matrixWorldInverse);
    const at = new THREE.Vector3();
    const keeps = this.model.inView(pane.index, () => this.slice.keeps);
    let best = REACH;
    let found: MarkHit | null = null;
    for (const { kind, data, offset } of lists)
      for (let from = offset; from < data.length; from += 8) {
        at.set(data[from]!, data[from + 1]!, data[from + 2]!).applyMatrix4(matrix);
        if (at.z < -1 || at.z > 1 || !keeps(data[from]!, data[from + 1]!, data[from + 2]!)) continue;
        const away = Math.hypot(box.left + ((at.x + 1) / 2) * box.width - x, box.top + ((1 - at.y) / 2) * box.height - y);
        if (away >= best) continue;
        best = away;
        found = { kind, place: Math.floor(from / 8) };
      }
    return found?.kind === "contacts" ? { kind: "contacts", place: contactWithPoint(this.model.frame!, found.place) } : found;
  }
}

/** The contact that has a point. */
function contactWithPoint(frame: FrameMessage, point: number): number {
  for (let place = 0; place < contactCount(frame); ++place) {
    const { first, count } = pointsAt(frame, place);
    if (point >= first && point < first + count) return place;
  }
  throw new Error("a point belongs to no contact");
}

/** Rows of eight numbers with a point at an offset. */
interface PointList {
  kind: MarkHit["kind"];
  data: Float32Array;
  offset: number;
}
