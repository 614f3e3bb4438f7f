/** What is below a point of the window, in the pane that is there; and where a point of the scene is in the window. */
import * as THREE from "three";
import { hasImpacts, selectableIn } from "../contacts";
import { readField } from "../fields/fields";
import type { Model } from "../model";
import type { ListName } from "../protocol/lists";
import { eachPlace } from "../records";
import type { Pane, Panes } from "./panes";
import { pick, type Hit } from "./picking";
import type { Slice } from "./slice";
import { DRAWN, styleOf } from "./styles";

/** A mark of the newest frame: a row of one of its lists. */
export interface MarkHit {
  list: ListName;
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
    const { frame } = this.model;
    return (frame && this.nearest(x, y, [selectableIn(frame).list])?.place) ?? -1;
  }

  /** The mark of a visible layer, or with a value of the shown field, that is closest to the cursor, or null. */
  markAt(x: number, y: number): MarkHit | null {
    const { frame } = this.model;
    return frame && this.nearest(x, y, DRAWN.filter((list) => list !== "contacts" || !hasImpacts(frame)));
  }

  private nearest(x: number, y: number, lists: ListName[]): MarkHit | null {
    const { frame, layers, objects } = this.model;
    const field = readField(this.model)?.form.list;
    const pane = this.panes.at(x, y);
    const box = this.boxOf(pane);
    pane.rig.camera.updateMatrixWorld();
    const matrix = new THREE.Matrix4().multiplyMatrices(pane.rig.camera.projectionMatrix, pane.rig.camera.matrixWorldInverse);
    const at = new THREE.Vector3();
    const keeps = this.model.inView(pane.index, () => this.slice.keeps);
    let best = REACH;
    let found: MarkHit | null = null;
    for (const list of lists.filter((list) => layers[styleOf(list).layer] || list === field))
      for (let place = 0; place < frame!.lists[list].count; ++place)
        eachPlace(frame!.lists[list], place, frame!.lists, objects, (data, from) => {
          at.set(data[from]!, data[from + 1]!, data[from + 2]!).applyMatrix4(matrix);
          if (at.z < -1 || at.z > 1 || !keeps(data[from]!, data[from + 1]!, data[from + 2]!)) return;
          const away = Math.hypot(box.left + ((at.x + 1) / 2) * box.width - x, box.top + ((1 - at.y) / 2) * box.height - y);
          if (away >= best) return;
          best = away;
          found = { list, place };
        });
    return found;
  }
}
