/** Where a slider begins, ends, and what one step of it is. */
export interface Range {
  low: number;
  high: number;
  step: number;
}

/** The next larger of 1, 2, 3, 5 times a power of ten. */
function round(size: number): number {
  const power = 10 ** Math.floor(Math.log10(size));
  return [1, 2, 3, 5, 10].map(f => f * power).find(f => f >= size * 0.999)!;
}

const within = (low: number, high: number): Range => ({
  low,
  high,
  step: 10 ** Math.floor(Math.log10((high - low) / 200)),
});

/** Of a parameter: from nothing to about three times what the text says; of either sign where it is 0. */
export function rangeOfParameter(value: number): Range {
  if (value === 0 || !Number.isFinite(value)) return within(-1, 1);
  const reach = round(3 * Math.abs(value));
  return value > 0 ? within(0, reach) : within(-reach, 0);
}

/** Of a start value: a full turn of an angle; else about three times the value, at least `scale`, to both sides. */
export function rangeOfStart(value: number, unit: string, scale: number): Range {
  if (unit === 'deg')
    return Math.abs(value) <= 180 ? within(-180, 180) : within(-round(Math.abs(value)), round(Math.abs(value)));
  const reach = round(Math.max(3 * Math.abs(value), scale));
  return within(-reach, reach);
}

/** A range that holds this value too. */
export function widened(range: Range, value: number): Range {
  if (value >= range.low && value <= range.high) return range;
  const reach = round(1.2 * Math.abs(value));
  return within(Math.min(range.low, value < 0 ? -reach : 0), Math.max(range.high, value > 0 ? reach : 0));
}

/** As many digits as a slider's step tells apart, or as the number has. */
export function shown(value: number): string {
  return String(Number(value.toPrecision(6)));
}
