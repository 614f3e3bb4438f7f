/** The palette of Okabe and Ito, which people with any type of colour vision can distinguish. */
export const OKABE_ITO = {
  orange: "#e69f00",
  sky: "#56b4e9",
  green: "#009e73",
  yellow: "#f0e442",
  blue: "#0072b2",
  vermillion: "#d55e00",
  purple: "#cc79a7",
} as const;

/** Colours of objects: pale, so that the dark colours of marks have a contrast of 3:1 on each of them. */
export const OBJECT_COLOURS = ["#8ecae6", "#f2c879", "#86d3b8", "#e9b8d2", "#a9bdf2", "#c9d1d8", "#b9d89c", "#dcbfa8", "#e3dc7a", "#f2b0a2", "#cdb0f0", "#8fd9dd"];
export const objectColour = (index: number): string => OBJECT_COLOURS[index % OBJECT_COLOURS.length]!;

/** Colours of marks, the same in both themes. A light halo separates them from a dark ground. */
export const MARKS = {
  contact: "#c1121f", depth: "#7b1fa2", normal: "#0b3d91", curve: "#00552b", pair: "#0b5d4e", candidate: "#1d4ed8", vertex: "#7b1fa2", vector: "#1b1b1b", selection: "#0b3d91",
} as const;
export const HALO = "#ffffff";

/** Colours of gaps, from those that take less than a quarter of the margins to those that take all of them. */
export const GAPS = ["#a63c00", "#7a5c00", "#00695c", "#1d4ed8"];
export const gapLevel = (share: number): number => (share < 0.25 ? 0 : share < 0.5 ? 1 : share < 0.75 ? 2 : 3);

/** Colours of octree levels and regions. */
export const LEVELS = [OKABE_ITO.blue, OKABE_ITO.orange, OKABE_ITO.green, OKABE_ITO.purple, OKABE_ITO.sky, OKABE_ITO.vermillion];
export const levelColour = (level: number): string => LEVELS[level % LEVELS.length]!;
