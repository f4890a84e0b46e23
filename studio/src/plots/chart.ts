import {corners} from './straighten';

/** A curve of a chart; `upTo`: it is drawn to this row only, as it grows with the motion. */
export interface Curve {
  x: ArrayLike<number | null>;
  y: ArrayLike<number | null>;
  series: number;
  label: string;
  faint?: boolean;
}
export interface ChartContent {
  curves: Curve[];
  x: string;
  y: string;
  overTime: boolean; // x is the time: a line shows the present
  marks?: number[]; // times of events
  uncertain?: number | null; // the time from which no digit of a curve is certain
  up?: [number, number]; // the range of y where the curves do not say it
  moves?: boolean; // the curves are those of the moment, and are drawn whole
}

/** Left, top, right, bottom. */
type Box = [number, number, number, number];

const room = {left: 62, right: 14, top: 12, bottom: 40};
const faces = `'STIX Two Text','Latin Modern Roman','Latin Modern Math',Cambria,'Times New Roman','DejaVu Serif',serif`;

const reader = document.createElement('canvas').getContext('2d')!;

/** Red, green and blue of any colour of a style sheet, 0 to 255: a canvas says it as #rrggbb. */
export function channels(colour: string): number[] {
  reader.fillStyle = colour;
  return [1, 3, 5].map(i => parseInt(String(reader.fillStyle).slice(i, i + 2), 16));
}

/** Places of ticks with 1, 2 or 5 times a power of ten between them. */
export function ticks(low: number, high: number, most: number): number[] {
  const raw = (high - low) / Math.max(1, most),
    power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].map(f => f * power).find(f => f >= raw * 0.999) ?? power;
  const out = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; ++k) out.push(k * step);
  return out;
}

/** The power of ten that all ticks of an axis are told in: 0 for sizes that one reads at a glance. */
function powerOf([low, high]: [number, number]): number {
  const size = Math.max(Math.abs(low), Math.abs(high));
  return size >= 1e5 || size < 1e-2 ? Math.floor(Math.log10(size)) : 0;
}

function tickText(value: number, step: number): string {
  if (value === 0 || Math.abs(value) < 1e-9 * step) return '0';
  return value.toFixed(Math.max(0, Math.min(9, -Math.floor(Math.log10(step) + 1e-9)))).replace('-', '−');
}

/** `x (m)` in thousandths is `x (10^{−3} m)`, to be written by `writeTitle`. */
function titleText(title: string, power: number): string {
  if (power === 0) return title;
  const factor = `10^{${String(power).replace('-', '−')}}`;
  return title.endsWith(')') ? title.replace(/\(([^()]*)\)$/, `(${factor} $1)`) : `${title} (${factor})`;
}

export function extent(curves: Curve[], key: 'x' | 'y'): [number, number] {
  let low = Infinity,
    high = -Infinity;
  for (const curve of curves)
    for (let i = 0; i < curve[key].length; ++i) {
      const value = curve[key][i];
      if (value === null || !Number.isFinite(value)) continue;
      if (value < low) low = value;
      if (value > high) high = value;
    }
  if (!(low <= high)) return [0, 1];
  const span = high - low,
    tiny = 1e-12 * Math.max(Math.abs(low), Math.abs(high));
  if (span <= tiny) {
    const around = Math.abs(low) > 0 ? Math.abs(low) * 0.1 : 1;
    return [low - around, high + around];
  }
  return key === 'x' ? [low, high] : [low - 0.05 * span, high + 0.05 * span];
}

/**
 * Curves on a canvas: what stays is drawn once, what has been passed grows on a second sheet, the present over both at
 * every tick, which puts back what it covered.
 */
export class Chart {
  private readonly canvas: HTMLCanvasElement;
  private readonly still = document.createElement('canvas');
  private readonly passed = document.createElement('canvas');
  private passedTo = 0; // row up to which `passed` is drawn
  private covered: Box[] | null = null; // by the present; null: everything is to be drawn
  private seen = true;
  private unpainted = false; // what stays was not drawn, as nobody saw it
  private content: ChartContent = {curves: [], x: '', y: '', overTime: true};
  private range = {x: [0, 1] as [number, number], y: [0, 1] as [number, number]};
  private width = 0;
  private height = 0;

  constructor(
    canvas: HTMLCanvasElement,
    private readonly onSeek: ((time: number) => void) | null,
  ) {
    this.canvas = canvas;
    new ResizeObserver(() => this.fit()).observe(canvas);
    new IntersectionObserver(entries => {
      this.seen = entries.at(-1)!.isIntersecting;
      if (this.seen && this.unpainted) this.paintStill();
      else if (this.seen) this.present(...this.lastPresent);
    }).observe(canvas);
    const seek = (event: PointerEvent): void => {
      if (!this.onSeek || !this.content.overTime || !(event.buttons & 1)) return;
      const box = canvas.getBoundingClientRect(),
        part = (event.clientX - box.left - room.left) / (this.width - room.left - room.right);
      this.onSeek(this.range.x[0] + Math.min(1, Math.max(0, part)) * (this.range.x[1] - this.range.x[0]));
    };
    canvas.addEventListener('pointerdown', event => {
      canvas.setPointerCapture(event.pointerId);
      seek(event);
    });
    canvas.addEventListener('pointermove', seek);
  }

  set(content: ChartContent): void {
    this.content = content;
    this.range = {x: extent(content.curves, 'x'), y: content.up ?? extent(content.curves, 'y')};
    if (!content.overTime && !content.moves) {
      const [low, high] = this.range.x,
        wider = 0.05 * (high - low);
      this.range.x = [low - wider, high + wider];
    }
    this.paintStill();
  }

  private fit(): void {
    const box = this.canvas.getBoundingClientRect(),
      ratio = window.devicePixelRatio || 1;
    if (box.width === 0) return;
    [this.width, this.height] = [box.width, box.height];
    for (const canvas of [this.canvas, this.still, this.passed])
      [canvas.width, canvas.height] = [Math.round(box.width * ratio), Math.round(box.height * ratio)];
    this.paintStill();
  }

  private across = (x: number): number =>
    room.left + ((x - this.range.x[0]) / (this.range.x[1] - this.range.x[0])) * (this.width - room.left - room.right);
  private down = (y: number): number =>
    this.height -
    room.bottom -
    ((y - this.range.y[0]) / (this.range.y[1] - this.range.y[0])) * (this.height - room.top - room.bottom);

  private colours(): (name: string) => string {
    const style = getComputedStyle(this.canvas);
    return name => style.getPropertyValue(name).trim();
  }

  private lastPresent: [number, number] = [0, 0];

  paintStill(): void {
    this.unpainted = !this.seen;
    if (this.width === 0 || !this.seen) return;
    const context = this.begin(this.still),
      colour = this.colours();
    this.paintAxes(context, colour);
    this.paintUncertain(context, colour);
    let last = -Infinity;
    for (const time of this.content.marks ?? []) {
      if (this.across(time) - last < 3) continue; // impacts that come to rest are one mark
      last = this.across(time);
      context.strokeStyle = colour('--muted');
      context.globalAlpha = 0.4;
      context.lineWidth = 0.8;
      context.setLineDash([3, 3]);
      line(context, this.across(time), room.top, this.across(time), this.height - room.bottom);
      context.setLineDash([]);
    }
    for (const curve of this.content.curves) {
      context.globalAlpha = curve.faint ? 0.55 : this.content.overTime || this.content.moves ? 1 : 0.28;
      this.stroke(context, curve, colour(`--series-${curve.series + 1}`), curve.faint ? 1 : 1.5, 0, curve.x.length);
    }
    this.begin(this.passed);
    this.passedTo = 0;
    this.covered = null;
    this.present(...this.lastPresent);
  }

  /** Where no digit is certain: beneath the curves, from that time to the end. */
  private paintUncertain(context: CanvasRenderingContext2D, colour: (name: string) => string): void {
    const {uncertain, overTime} = this.content;
    if (!overTime || uncertain === null || uncertain === undefined) return;
    const bottom = this.height - room.bottom,
      end = this.across(this.range.x[1]),
      from = Math.min(end, Math.max(room.left, this.across(uncertain)));
    context.fillStyle = colour('--warn');
    context.globalAlpha = 0.12;
    context.fillRect(from, room.top, end - from, bottom - room.top);
    context.globalAlpha = 1;
    context.font = `italic 13px ${faces}`;
    context.textAlign = 'left';
    context.fillStyle = colour('--warn');
    if (end - from > 90) context.fillText('not certain', from + 6, room.top + 13);
  }

  private begin(canvas: HTMLCanvasElement): CanvasRenderingContext2D {
    const context = canvas.getContext('2d')!,
      ratio = window.devicePixelRatio || 1;
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.globalAlpha = 1;
    context.clearRect(0, 0, this.width, this.height);
    context.lineJoin = context.lineCap = 'round';
    return context;
  }

  private stroke(
    context: CanvasRenderingContext2D,
    curve: Curve,
    colour: string,
    width: number,
    first: number,
    end: number,
  ): void {
    context.save();
    context.beginPath();
    context.rect(
      room.left,
      room.top - 4,
      this.width - room.left - room.right + 2,
      this.height - room.top - room.bottom + 8,
    );
    context.clip();
    context.strokeStyle = colour;
    context.lineWidth = width;
    context.beginPath();
    let xs: number[] = [],
      ys: number[] = [];
    const draw = (): void => {
      if (xs.length > 0)
        corners(xs, ys, 0.15).forEach((k, i) => (i ? context.lineTo(xs[k], ys[k]) : context.moveTo(xs[k], ys[k])));
      [xs, ys] = [[], []];
    };
    for (let i = first; i < Math.min(end, curve.x.length); ++i) {
      const x = curve.x[i],
        y = curve.y[i];
      if (x === null || y === null || !Number.isFinite(x) || !Number.isFinite(y)) draw();
      else xs.push(this.across(x)), ys.push(this.down(y));
    }
    draw();
    context.stroke();
    context.restore();
  }

  private paintAxes(context: CanvasRenderingContext2D, colour: (name: string) => string): void {
    const {width, height} = this,
      bottom = height - room.bottom,
      right = width - room.right;
    context.font = `13px ${faces}`;
    context.lineWidth = 1;
    const xs = ticks(...this.range.x, Math.max(2, (right - room.left) / 75)),
      ys = ticks(...this.range.y, Math.max(2, (bottom - room.top) / 26)),
      powers = {x: powerOf(this.range.x), y: powerOf(this.range.y)},
      told = (value: number, all: number[], power: number): string =>
        tickText(value / 10 ** power, (all[1] - all[0] || 1) / 10 ** power);
    context.strokeStyle = colour('--grid');
    for (const x of xs) line(context, this.across(x), room.top, this.across(x), bottom);
    for (const y of ys) line(context, room.left, this.down(y), right, this.down(y));
    context.fillStyle = colour('--muted');
    context.textAlign = 'center';
    for (const x of xs) context.fillText(told(x, xs, powers.x), this.across(x), bottom + 16);
    context.textAlign = 'right';
    for (const y of ys) context.fillText(told(y, ys, powers.y), room.left - 7, this.down(y) + 4);
    context.strokeStyle = colour('--muted');
    line(context, room.left, bottom, right, bottom);
    line(context, room.left, room.top, room.left, bottom);
    context.fillStyle = colour('--ink');
    context.textAlign = 'center';
    context.font = `italic 14px ${faces}`;
    writeTitle(context, titleText(this.content.x, powers.x), (room.left + right) / 2, height - 6);
    context.save();
    context.translate(14, (room.top + bottom) / 2);
    context.rotate(-Math.PI / 2);
    writeTitle(context, titleText(this.content.y, powers.y), 0, 0);
    context.restore();
  }

  /** Draws what was passed up to this row; where it drew, or null where it began anew. */
  private grow(row: number, colour: (name: string) => string): Box[] | null {
    const anew = row < this.passedTo,
      first = anew ? 0 : this.passedTo;
    if (anew) this.begin(this.passed);
    if (row === first) return anew ? null : [];
    const context = this.passed.getContext('2d')!,
      curves = this.content.curves.filter(curve => !curve.faint);
    for (const curve of curves)
      this.stroke(context, curve, colour(`--series-${curve.series + 1}`), 1.6, first, row + 1);
    this.passedTo = row;
    return anew ? null : curves.map(curve => this.boxOf(curve, first, row + 1));
  }

  private boxOf(curve: Curve, first: number, end: number): Box {
    const box: Box = [Infinity, Infinity, -Infinity, -Infinity];
    for (let i = first; i < end; ++i) {
      const x = curve.x[i],
        y = curve.y[i];
      if (x !== null && y !== null && Number.isFinite(x) && Number.isFinite(y))
        include(box, this.across(x), this.down(y), 2);
    }
    return box;
  }

  /** What lies under the present is put back here, to whole pixels. */
  private putBack(context: CanvasRenderingContext2D, box: Box): void {
    const ratio = window.devicePixelRatio || 1,
      [left, top] = [0, 1].map(k => Math.max(0, Math.floor(box[k] * ratio))),
      right = Math.min(this.canvas.width, Math.ceil(box[2] * ratio)),
      bottom = Math.min(this.canvas.height, Math.ceil(box[3] * ratio)),
      [width, height] = [right - left, bottom - top];
    if (!(width > 0 && height > 0)) return;
    context.save();
    context.resetTransform();
    context.clearRect(left, top, width, height);
    for (const sheet of this.grows ? [this.still, this.passed] : [this.still])
      context.drawImage(sheet, left, top, width, height, left, top, width, height);
    context.restore();
  }

  private get grows(): boolean {
    return !this.content.overTime && !this.content.moves;
  }

  /** The present: the time, and the row that is next to it. Only what it covered and covers is drawn. */
  present(time: number, row: number): void {
    this.lastPresent = [time, row];
    if (this.width === 0 || !this.seen) return;
    const context = this.covered === null ? this.begin(this.canvas) : this.canvas.getContext('2d')!,
      colour = this.colours(),
      grown = this.grows ? this.grow(row, colour) : [];
    const outdated = this.covered === null || grown === null ? [[0, 0, this.width, this.height] as Box] : this.covered;
    for (const box of [...outdated, ...(grown ?? [])]) this.putBack(context, box);
    this.covered = [];
    if (this.content.overTime) {
      const x = this.across(time);
      context.strokeStyle = colour('--ink');
      context.globalAlpha = 0.6;
      context.lineWidth = 1;
      line(context, x, room.top, x, this.height - room.bottom);
      context.globalAlpha = 1;
      this.covered.push([x - 2, room.top - 2, x + 2, this.height - room.bottom + 2]);
    }
    if (this.content.moves) return;
    for (const curve of this.content.curves) {
      if (curve.faint) continue;
      const x = this.content.overTime ? time : curve.x[row],
        y = curve.y[row];
      if (x === null || y === null || x === undefined || y === undefined || !Number.isFinite(y)) continue;
      const [px, py] = [this.across(x), this.down(y)];
      context.fillStyle = colour(`--series-${curve.series + 1}`);
      context.beginPath();
      context.arc(px, py, 4, 0, 2 * Math.PI);
      context.fill();
      this.covered.push([px - 6, py - 6, px + 6, py + 6]);
    }
  }
}

function include(box: Box, x: number, y: number, around: number): void {
  box[0] = Math.min(box[0], x - around);
  box[1] = Math.min(box[1], y - around);
  box[2] = Math.max(box[2], x + around);
  box[3] = Math.max(box[3], y + around);
}

/** Centred at x. An exponent is a smaller number above the line: signs for raised digits come from several faces. */
function writeTitle(context: CanvasRenderingContext2D, title: string, x: number, y: number): void {
  const large = context.font,
    faceOf = (i: number): string => (i % 2 ? large.replace(/\d+px/, '10px') : large);
  const parts = title.split(/\^\{([^}]*)\}/).map((text, i) => {
    context.font = faceOf(i);
    return {text, font: faceOf(i), up: i % 2 ? 5 : 0, width: context.measureText(text).width};
  });
  let at = x - parts.reduce((sum, part) => sum + part.width, 0) / 2;
  context.textAlign = 'left';
  for (const part of parts) {
    context.font = part.font;
    context.fillText(part.text, at, y - part.up);
    at += part.width;
  }
  context.font = large;
  context.textAlign = 'center';
}

function line(context: CanvasRenderingContext2D, x1: number, y1: number, x2: number, y2: number): void {
  context.beginPath();
  context.moveTo(x1, y1);
  context.lineTo(x2, y2);
  context.stroke();
}
