/**
 * Reads the binary messages of the session (viewer/PROTOCOL.md). It validates all data that the page relies on
 * and returns typed arrays that view the message; nothing is copied.
 */
import type { AnswerMessage, FailureMessage, Message, SeriesMessage } from "./messages";
import { checkEvents, readFrame } from "./read_frame";
import { readScene, type SceneCounts } from "./read_scene";
import { ALIGNMENT, fail, isNumber, isText, isTexts, need, readSections, type Sections } from "./read_sections";
import { KINDS } from "./sections_generated";

const MAGIC = 0x4c505553;
const VERSION = 2;

function readSeries(sections: Sections, scene: SceneCounts): SeriesMessage {
  const events = sections.events("series_");
  checkEvents(events, scene.vertices.length);
  return { kind: "series", values: sections.one("series", new Float64Array(0)), events };
}

function readAnswer(sections: Sections): AnswerMessage {
  const text = sections.json() as AnswerMessage["text"];
  need(isNumber(text.id), "id");
  return { kind: "answer", text };
}

function readFailure(sections: Sections): FailureMessage {
  const text = sections.json() as FailureMessage["text"];
  need(isText(text.message), "message");
  need(typeof text.fatal === "boolean", "fatal");
  need(text.layers === undefined || isTexts(text.layers), "layers");
  return { kind: "failure", text };
}

const NO_SCENE: SceneCounts = {
  generation: -1, vertices: [], triangles: [], statistics: 0, series: 0, fields: [], faces: [],
};

/**
 * Reads one message. `scene` has the sizes from the last scene message, or is null before the first one.
 * Throws `MessageError` with one sentence when the data is not a message of this version.
 */
export function readMessage(buffer: ArrayBuffer, scene: SceneCounts | null): Message {
  if (buffer.byteLength < ALIGNMENT) fail("it is shorter than a header");
  const view = new DataView(buffer);
  if (view.getUint32(0, true) !== MAGIC) fail("it does not begin like a message of Supple");
  const version = view.getUint16(4, true);
  if (version !== VERSION) fail(`it has version ${version}, and this page reads version ${VERSION}`);
  if (view.getUint32(8, true) !== buffer.byteLength || buffer.byteLength % ALIGNMENT !== 0) fail("its length differs from its header");
  const kind = KINDS[view.getUint16(6, true)];
  if (!kind) fail("it has an unknown kind");
  const counts = scene ?? NO_SCENE;
  if ((kind === "frame" || kind === "series") && !scene) fail(`a ${kind} came before the scene`);
  const sections = readSections(buffer, kind, view.getUint32(12, true), counts.series);
  switch (kind) {
    case "scene": return readScene(sections);
    case "frame": return readFrame(sections, counts);
    case "answer": return readAnswer(sections);
    case "failure": return readFailure(sections);
    case "series": return readSeries(sections, counts);
  }
}
