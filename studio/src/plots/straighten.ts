/**
 * The corners of a curve that are seen: no point of it is farther than `tolerance` from the line through them. What it
 * costs to draw a curve grows with its corners, and a run has many rows in a pixel.
 *
 * From a corner on, a sleeve: the directions in which a straight line passes all points so far. The point before the
 * first one that lies outside of it, or nearer to the corner, is the next corner.
 */
export function corners(x: ArrayLike<number>, y: ArrayLike<number>, tolerance: number): number[] {
  const out = [0],
    last = x.length - 1;
  let from = 0, // the corner
    far = 0, // of the point before from it
    left: Direction = null, // the borders of the sleeve
    right: Direction = null;
  for (let i = 1; i <= last; ++i) {
    let dx = x[i] - x[from],
      dy = y[i] - y[from],
      r = Math.hypot(dx, dy);
    if (r < far || (left && right && (cross(right, [dx, dy]) < 0 || cross([dx, dy], left) < 0))) {
      from = i - 1;
      out.push(from);
      left = right = null;
      [dx, dy] = [x[i] - x[from], y[i] - y[from]];
      r = Math.hypot(dx, dy);
    }
    far = r;
    if (r <= tolerance) continue; // any direction passes it
    const sine = tolerance / r,
      cosine = Math.sqrt(1 - sine * sine),
      newLeft: Direction = [dx * cosine - dy * sine, dx * sine + dy * cosine],
      newRight: Direction = [dx * cosine + dy * sine, dy * cosine - dx * sine];
    if (!left || cross(newLeft, left) > 0) left = newLeft;
    if (!right || cross(right, newRight) > 0) right = newRight;
  }
  if (last > 0) out.push(last);
  return out;
}

type Direction = [number, number] | null;
const cross = (a: [number, number], b: [number, number]): number => a[0] * b[1] - a[1] * b[0];
