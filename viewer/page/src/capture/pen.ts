/** Draws texts and boxes on a canvas or as SVG, in CSS pixels, so that both kinds of pictures look the same. */

export interface Text {
  size: number;
  colour: string;
  /** Surrounds the letters, so that they are readable on any ground; null for none. */
  halo: string | null;
  align: "start" | "middle" | "end";
}

export interface Pen {
  box(x: number, y: number, width: number, height: number, fill: string, edge: string | null): void;
  /** `y` is that of the baseline. */
  text(x: number, y: number, text: string, style: Text): void;
}

const FONT = 'system-ui, "DejaVu Sans", Arial, sans-serif';
const HALO_WIDTH = 3;

/** `scale`: pixels of the canvas in a CSS pixel. */
export function canvasPen(context: CanvasRenderingContext2D, scale: number): Pen {
  context.setTransform(scale, 0, 0, scale, 0, 0);
  context.lineJoin = "round";
  return {
    box(x, y, width, height, fill, edge) {
      if (fill !== "none") {
        context.fillStyle = fill;
        context.fillRect(x, y, width, height);
      }
      if (edge === null) return;
      context.strokeStyle = edge;
      context.lineWidth = 1;
      context.strokeRect(x, y, width, height);
    },
    text(x, y, text, { size, colour, halo, align }) {
      context.font = `${size}px ${FONT}`;
      context.textAlign = align === "middle" ? "center" : align;
      if (halo !== null) {
        context.strokeStyle = halo;
        context.lineWidth = HALO_WIDTH;
        context.strokeText(text, x, y);
      }
      context.fillStyle = colour;
      context.fillText(text, x, y);
    },
  };
}

export const escaped = (text: string): string =>
  text.replace(/[&<>"]/g, (letter) => `&#${letter.charCodeAt(0)};`).replace(/[^\t\n\r\u0020-\ud7ff\ue000-\ufffd\u{10000}-\u{10ffff}]/gu, "\ufffd");

/** Two decimals are finer than any printer. */
export const short = (x: number): string => String(Math.round(100 * x) / 100);

/** Adds elements to `parts`. */
export function svgPen(parts: string[]): Pen {
  return {
    box(x, y, width, height, fill, edge) {
      parts.push(`<rect x="${short(x)}" y="${short(y)}" width="${short(width)}" height="${short(height)}" fill="${fill}"${edge === null ? "" : ` stroke="${edge}"`}/>`);
    },
    text(x, y, text, { size, colour, halo, align }) {
      const ring = halo === null ? "" : ` stroke="${halo}" stroke-width="${HALO_WIDTH}" stroke-linejoin="round" paint-order="stroke"`;
      parts.push(`<text x="${short(x)}" y="${short(y)}" font-family="${escaped(FONT)}" font-size="${short(size)}" text-anchor="${align}" fill="${colour}"${ring}>${escaped(text)}</text>`);
    },
  };
}

export interface Sheet {
  /** In CSS pixels. */
  width: number;
  height: number;
  /** The width in print; null for CSS pixels. */
  millimetres: number | null;
}

const MILLIMETRES_PER_INCH = 25.4;
export const millimetresOf = (pixels: number, dpi: number): number => (pixels / dpi) * MILLIMETRES_PER_INCH;

export function svgFile({ width, height, millimetres }: Sheet, parts: string[]): string {
  const size = (length: number) => (millimetres === null ? short(length) : `${short((length / width) * millimetres)}mm`);
  return (
    `<svg xmlns="http://www.w3.org/2000/svg" width="${size(width)}" height="${size(height)}" viewBox="0 0 ${short(width)} ${short(height)}">\n` +
    `${parts.join("\n")}\n</svg>\n`
  );
}
