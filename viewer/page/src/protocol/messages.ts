/** The messages of the session (viewer/PROTOCOL.md): typed arrays that view the message, and texts. */
import type { FieldForm } from "./field_form";
import type { Lists } from "./lists";
import type { ARRAYS, FORMS, Form } from "./sections_generated";

export const NONE = 0xffffffff;

export interface SceneObject {
  name: string;
  vertices: number;
  triangles: number;
  static: boolean;
  body: boolean;
  waves?: boolean;
  rigid?: boolean;
  self_collision: boolean;
  /** Within which its pairs are near. */
  margin: number;
  /** The object of a program is gone; its number stays. */
  removed?: boolean;
}

export type Vector = [number, number, number];

/** The description of an option, from the library. */
export interface Setting {
  key: string;
  doc: string;
  unit: string;
  kind: "word" | "truth" | "whole" | "number" | "cube";
  /** The values that are allowed, in words; of kinds that are numbers. */
  range?: string;
  words?: string[];
  /** A change restarts the simulation. */
  restarts: boolean;
}

/** An event that can pause a program: on or off, or the number above which it happens, null for never. */
export interface BreakSetting {
  key: string;
  doc: string;
  unit: string;
  kind: "truth" | "number";
  value: boolean | number | null;
}

/** Why a program is paused. */
export interface Break {
  event: string;
  text: string;
  objects: number[];
  point: Vector | null;
}

/** Two recordings that are shown together, and the frame that differs first; the text is empty when nothing does. */
export interface Comparison {
  names: [string, string];
  /** The first objects are those of the first recording. */
  objects_of_a: number;
  /** Null when only the headers differ. */
  frame: number | null;
  text: string;
}

/** A number that is measured of a pin. */
export interface PinValue {
  key: string;
  doc: string;
  unit: string;
}

export interface SceneText {
  version: string;
  title: string;
  source: "simulation" | "recording" | "program";
  generation: number;
  /** Counts restarts: the steps of one run follow each other. */
  run: number;
  center: Vector;
  bounds: [Vector, Vector];
  border?: [Vector, Vector] | null;
  objects: SceneObject[];
  frames: number | null;
  comparison: Comparison | null;
  time_step: number;
  /** Digits, because numbers of JavaScript are exact only up to 2^53. */
  seed: string;
  contacts: string;
  /** What the command `set` takes. The scene has the value of each, by its key. */
  settings: Setting[];
  /** What the command `layers` takes as field. */
  fields: FieldForm[];
  can: string[];
  statistics: string[];
  series: string[];
  /** The numbers in a row of a pin, after step and time. */
  pin_values: PinValue[];
  warnings: string[];
  /** Only of a program. */
  breaks?: BreakSetting[];
  /** The names of objects of which contacts begin; empty for any. */
  break_objects?: string[];
}

export interface FrameText {
  generation: number;
  step: number;
  time: number;
  broad_phase_method?: string;
  playing: boolean;
  speed: number;
  loop?: boolean;
  /** The first and the last step of the section that loops. */
  section: [number, number] | null;
  /** The first and the last step that can be shown. */
  range: [number, number];
  /** While the session measures pins in other frames of a recording: how many are measured, and how many there are. */
  pin_frames: [number, number] | null;
  /** A kept step of a simulation or a program, not the newest. */
  past: boolean;
  /** The key of the field whose values the frame has. */
  field: string | null;
  octree_levels: (number | null)[];
  omitted: Record<string, number>;
  /** Kinds of contacts for which there was nothing to test, and why. */
  untested: { kind: string; reason: string }[];
  /** Of a program that an event has paused. */
  break?: Break | null;
}

/** What begins and ends: contacts, collisions of the narrow phase, overlaps of the objects' volumes. */
export const EVENT_KINDS = ["contact", "narrow_phase", "volume"] as const;
export type EventKind = (typeof EVENT_KINDS)[number];
/** For each event the step, or the frame of a recording, and two objects. */
export type EventData = Record<EventKind, { begin: Uint32Array; end: Uint32Array }>;

export interface SceneMessage {
  kind: "scene";
  text: SceneText;
  /** Per object the vertices of triangles, and of edges and points of no triangle. */
  triangles: Map<number, Uint32Array>;
  edges: Map<number, Uint32Array>;
  points: Map<number, Uint32Array>;
}

type FormOfFrame = Extract<(typeof FORMS)[keyof typeof FORMS], { kinds: readonly ["frame"] }>;
type Camel<Name> = Name extends `${infer First}_${infer Rest}` ? `${First}${Capitalize<Camel<Rest> & string>}` : Name;
type ArrayOf<F extends Form> = InstanceType<(typeof ARRAYS)[F["scalar"]]>;
/** The sections of frames as members, with camelCase names; those of each object are maps. */
export type FrameSections = {
  [F in FormOfFrame as F["name"] extends "column" | `${EventKind}_${"begin" | "end"}` ? never : Camel<F["name"]> & string]:
    F["is_of_object"] extends true ? Map<number, ArrayOf<F>> : ArrayOf<F>;
};

/** Missing sections and lists are empty. Positions are present for objects that moved. */
export type FrameMessage = {
  kind: "frame"; text: FrameText; events: EventData; lists: Lists;
  /** The statistics of each step that the page has not yet, row by row; `statistics` is the last row. */
  steps: Float64Array;
} & FrameSections;

export interface AnswerMessage {
  kind: "answer";
  text: { id: number } & Record<string, unknown>;
}

export interface FailureMessage {
  kind: "failure";
  text: { message: string; fatal: boolean; id?: number; layers?: string[] };
}

export interface SeriesMessage {
  kind: "series";
  values: Float64Array;
  events: EventData;
}

export type Message = SceneMessage | FrameMessage | AnswerMessage | FailureMessage | SeriesMessage;
