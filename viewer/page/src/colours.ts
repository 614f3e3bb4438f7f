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

/** Colours of objects. Vermillion is reserved for contacts, yellow for the selection. */
const OBJECTS = ["#56b4e9", "#e6b450", "#3fae8f", "#cc9bb9", "#4f8fc0", "#a9b4bd", "#8fb87a", "#b79a86"];
export const objectColour = (index: number): string => OBJECTS[index % OBJECTS.length]!;

/** Colours of octree levels and regions. */
export const LEVELS = [OKABE_ITO.blue, OKABE_ITO.orange, OKABE_ITO.green, OKABE_ITO.purple, OKABE_ITO.sky, OKABE_ITO.vermillion];
/** The level of the colour of a proximity pair: vermillion up to a quarter of the margins, then orange, green, blue. */
export const proximityLevel = (share: number): number => (share < 0.25 ? 5 : share < 0.5 ? 1 : share < 0.75 ? 2 : 0);
export const levelColour = (level: number): string => LEVELS[level % LEVELS.length]!;
