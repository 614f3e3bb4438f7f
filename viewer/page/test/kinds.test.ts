/** Reads messages of real sessions in which every kind of every record occurs (tests/viewer_page). */
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { contactCount, findContact, keyAt, kindAt, pointsAt, sidesOf } from "../src/contacts";
import type { FrameMessage } from "../src/protocol/messages";
import { readMessage } from "../src/protocol/read_message";
import { countsOf, type SceneCounts } from "../src/protocol/read_scene";
import { readsTag } from "../src/protocol/read_sections";
import { STAGES } from "../src/stages";

declare const process: { env: Record<string, string | undefined> };
const folder = process.env["SUPPLE_PAGE_KINDS"];

/** The tags of the sections of a message. */
function tagsIn(buffer: ArrayBuffer): number[] {
  const view = new DataView(buffer);
  const tags: number[] = [];
  for (let at = 16; at < buffer.byteLength; at += 16 + Math.ceil(view.getUint32(at + 12, true) / 16) * 16) tags.push(view.getUint32(at, true));
  return tags;
}

/** What the tables and the inspector show of each contact. */
function useContacts(frame: FrameMessage, { kinds, vertices, triangles }: SceneCounts): number {
  const count = contactCount(frame);
  for (let place = 0; place < count; ++place) {
    const key = keyAt(frame, place);
    assert.ok(findContact(frame, key) >= 0);
    assert.ok(kindAt(frame, place, kinds).length > 0);
    assert.ok(pointsAt(frame, place).count > 0);
    for (const { object, elements, isFace } of sidesOf(key, kinds))
      for (const element of elements) assert.ok(element < (isFace ? triangles : vertices)[object]!);
  }
  return count;
}

test("every kind of every record is read", { skip: folder === undefined }, () => {
  const { sessions, stages } = JSON.parse(readFileSync(`${folder}/kinds.json`, "utf8")) as { sessions: string[][]; stages: string[] };
  assert.deepEqual(Object.keys(STAGES).sort(), [...stages].sort());
  const kinds = { contact: new Set<number>(), impact: new Set<number>(), certainty: new Set<number>(), curve: new Set<number>() };
  let last: SceneCounts | null = null;
  for (const files of sessions) {
    let counts: SceneCounts | null = null;
    let contacts = 0;
    for (const file of files) {
      const bytes = readFileSync(`${folder}/${file}`);
      const buffer = new Uint8Array(bytes).buffer;
      for (const tag of tagsIn(buffer)) assert.ok(readsTag(tag), `the page does not read sections with the tag ${tag}`);
      const read = readMessage(buffer, counts);
      if (read.kind === "scene") last = counts = countsOf(read);
      assert.ok(read.kind !== "failure", JSON.stringify(read.kind === "failure" && read.text));
      if (read.kind !== "frame") continue;
      contacts += useContacts(read, counts!);
      for (let i = 0; i < read.contacts.length; i += 8) kinds.contact.add(read.contacts[i + 4]!);
      for (let i = 0; i < read.impacts.length; i += 8) {
        kinds.impact.add(read.impacts[i + 6]!);
        kinds.certainty.add(read.impacts[i + 7]!);
      }
      for (let i = 0; i < read.curves.length; i += 8) kinds.curve.add(read.curves[i + 2]!);
    }
    assert.ok(contacts > 0);
  }
  for (const [record, found] of Object.entries(kinds)) assert.equal(found.size, last!.kinds[record as keyof typeof kinds].length, record);
});
