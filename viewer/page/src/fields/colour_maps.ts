/**
 * Colour maps that people with any type of colour vision can read. They are those of matplotlib 3.11: viridis,
 * magma and inferno by S. van der Walt and N. Smith (CC0), cividis by J. Nuñez, C. Anderton and R. Renslow (CC0),
 * coolwarm by K. Moreland (BSD). Of each, 33 of 256 colours; between them, the difference is at most 2 of 255,
 * and 6 at the bright end of cividis.
 */
const TABLES = {
  viridis:
    "440154470d6048186a482374472d7b4536814240863f49893b528b375a8d33638d2f6a8e2c728e297a8e26818e23898e21908c1f988b1f9f8821a68528ae8031b57b3ebc744cc26c5dc9636ece5882d34c96d83fabdc32c0df24d5e21aeae51afde725",
  cividis:
    "00224e00285b002e6a0433711a386f273e6e32436d3b496c434e6c4b546c52596d5a5f6e61656f686a716f70737576767c7b788481798b8778938d789b9376a39a75aba072b3a670bbad6cc3b469ccba64d4c15fddc958e6d051efd748f8df3cfee838",
  magma:
    "0000040303110a0822130d331d114628115a36106a430f7650127c5d177f691c817621818226818f2a819c2e7fa9327db63779c33b75cf4170db486ae65163ee5c5ef5695cf9785dfb8761fd9668fea571feb47bfec387fed194fde0a2fceeb0fcfdbf",
  inferno:
    "0000040403120b0724150b37210c4a2e0a5a3c09654a0c6b57106d63146e70196e7d1e6d89226a962766a32b61af315cbb3755c63e4dd14644db4f3be35932eb6528f1711ef67f14f98d0afb9c06fcab0ffbba1ff9ca32f5d949f2e865f3f586fcffa4",
  coolwarm:
    "3b4cc0445acc4d68d75775e16282ea6c8ef1779af782a5fb8db0fe98b9ffa3c2feaec9fcb8d0f9c2d5f4ccd9eed5dbe6dddddde5d8d1ecd3c5f1ccb9f4c4adf7bba0f7b194f7a687f49a7bf18d6fec7f63e57058de604dd55042cb3e38c0282fb40426",
} as const;

export type MapName = keyof typeof TABLES;
export const MAPS = Object.keys(TABLES) as MapName[];
/** Its middle stands for zero. */
export const isDiverging = (map: MapName): boolean => map === "coolwarm";

export const MAP_COLOURS = 256;

/** Red, green and blue from 0 to 255 (sRGB) at a place from 0 to 1. */
export function colourAt(map: MapName, share: number): [number, number, number] {
  const table = TABLES[map];
  const last = table.length / 6 - 1;
  const place = last * Math.max(0, Math.min(1, share));
  const from = Math.min(Math.floor(place), last - 1);
  const part = (at: number, channel: number) => parseInt(table.slice(6 * at + 2 * channel, 6 * at + 2 * channel + 2), 16);
  return [0, 1, 2].map((channel) => Math.round(part(from, channel) + (place - from) * (part(from + 1, channel) - part(from, channel)))) as [number, number, number];
}
