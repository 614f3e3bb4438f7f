/** Reads messages of real sessions in which every kind of every record occurs (tests/viewer_page). */
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { findContact, pointsOf, selectableIn, sidesOf } from "../src/contacts";
import { columnOf, type ListName } from "../src/protocol/lists";
import type { FrameMessage } from "../src/protocol/messages";
import { readMessage } from "../src/protocol/read_message";
import { countsOf, type SceneCounts } from "../src/protocol/read_scene";
import { readsTag } from "../src/protocol/read_sections";
import { hasColumn, keyAt, kindAt } from "../src/records";
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
function useContacts(frame: FrameMessage, { vertices, triangles }: SceneCounts): number {
  const rows = selectableIn(frame);
  for (let place = 0; place < rows.count; ++place) {
    const key = keyAt(rows, place);
    assert.ok(findContact(frame, key) >= 0);
    assert.ok(kindAt(rows, place).length > 0);
    assert.ok(pointsOf(frame, [], rows, place).length > 0);
    for (const { object, kind, elements } of sidesOf(key))
      for (const element of elements) assert.ok(element < (kind === "face" ? triangles : vertices)[object]!);
  }
  return rows.count;
}

test("every kind of every record is read", { skip: folder === undefined }, () => {
  const { sessions, stages } = JSON.parse(readFileSync(`${folder}/kinds.json`, "utf8")) as { sessions: string[][]; stages: string[] };
  assert.deepEqual(Object.keys(STAGES).sort(), [...stages].sort());
  const found = new Map(["contacts", "continuous_contacts", "curves"].flatMap((list) => ["kind", "certainty"].filter((name) => hasColumn(list as ListName, name)).map((name) => [`${list}.${name}`, new Set<number>()])));
  for (const files of sessions) {
    let counts: SceneCounts | null = null;
    let contacts = 0;
    for (const file of files) {
      const bytes = readFileSync(`${folder}/${file}`);
      const buffer = new Uint8Array(bytes).buffer;
      for (const tag of tagsIn(buffer)) assert.ok(readsTag(tag), `the page does not read sections with the tag ${tag}`);
      const read = readMessage(buffer, counts);
      if (read.kind === "scene") counts = countsOf(read);
      assert.ok(read.kind !== "failure", JSON.stringify(read.kind === "failure" && read.text));
      if (read.kind !== "frame") continue;
      contacts += useContacts(read, counts!);
      for (const [column, words] of found) {
        const [list, name] = column.split(".") as [ListName, string];
        for (const word of read.lists[list].columns[name]!) words.add(word);
      }
    }
    assert.ok(contacts > 0);
  }
  for (const [column, words] of found) {
    const [list, name] = column.split(".") as [ListName, string];
    assert.equal(words.size, columnOf(list, name)!.words.length, column);
  }
});
