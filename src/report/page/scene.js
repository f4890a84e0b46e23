// A moment of a drawing as strokes in px, for any view: what src/drawing/view.cpp and frame.cpp do, so that a reader
// can turn it.
// Geometry is in the scene; here are the camera, what it hides, and which lies in front. A test compares the two.
'use strict';
const maupScene = (() => {
  const bodyTint = 0.22, wholeTrail = 0.2, idsOfAnElement = 4096, contour = 48, awayInRadii = 6;
  const hypot = Math.hypot, finite = p => p.every(Number.isFinite);
  const series = (index, strength = 1) => ({ink: 'series', series: index, strength});
  const plain = (ink, strength = 1) => ({ink, series: 0, strength});

  // ------------------------------------------------------------------------------------------------ motion in time

  const duration = scene => Math.abs(scene.times[scene.times.length - 1] - scene.times[0]);
  const direction = scene => scene.times[scene.times.length - 1] < scene.times[0] ? -1 : 1;

  function frameBefore(times, way, s) {
    let low = 0, high = times.length - 1;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (way * (times[middle] - times[0]) <= s) low = middle; else high = middle;
    }
    return low;
  }

  // Cubic interpolation through the neighbouring frames (Catmull-Rom on uneven times), exact at each; the nearer one
  // where the motion swings faster than frames follow.
  function trackAt(scene, track, width, s) {
    const times = scene.times, way = direction(scene), last = times.length - 1;
    if (last === 0) return track.slice(0, width);
    const i = frameBefore(times, way, s), h = way * (times[i + 1] - times[i]);
    const part = h > 0 ? Math.min(1, Math.max(0, (s - way * (times[i] - times[0])) / h)) : 0;
    const u = scene.momentsOnly ? (part < 0.5 ? 0 : 1) : part, w = 1 - u;
    if (u === 0 || u === 1) return track.slice((i + u) * width, (i + u + 1) * width);
    const result = new Array(width);
    for (let k = 0; k < width; ++k) {
      const value = f => track[f * width + k], p = value(i), q = value(i + 1);
      const slope = f =>
        f <= 0 || f >= last ? q - p : (value(f + 1) - value(f - 1)) / (way * (times[f + 1] - times[f - 1])) * h;
      result[k] = p * (1 + 2 * u) * w * w + q * (3 - 2 * u) * u * u + slope(i) * u * w * w - slope(i + 1) * u * u * w;
    }
    return result;
  }

  const pointsAt = (scene, element, s) =>
    element.still ? element.positions : trackAt(scene, element.positions, element.points * scene.dimension, s);

  // --------------------------------------------------------------------------------------------------------- camera

  // A view as near as every direction allows; `azimuth` and `elevation` of the eye, in rad.
  function makeView(scene, width, height, {azimuth = -0.9, elevation = 0.32, furniture = true} = {}) {
    const unit = Math.max(0.6, Math.sqrt(width * height) / 588), room = 28, strip = 34;
    const middle = scene.low.map((low, k) => (low + scene.high[k]) / 2);
    const view = {width, height, unit, middle, across: width / 2, down: height / 2};
    if (scene.dimension === 2) {
      const right = scene.gravity.length && furniture ? strip * unit : 0, below = furniture ? 0.6 * strip * unit : 0;
      const w = width - 2 * room * unit - right, h = height - 2 * room * unit - below;
      const [x, y] = scene.low.map((low, k) => scene.high[k] - low);
      view.scale = x > 0 || y > 0 ? Math.min(w / (x > 0 ? x : 1e-300), h / (y > 0 ? y : 1e-300)) : Math.min(w, h) / 2;
      view.across = (width - right) / 2;
      view.down = (height - below) / 2;
      return view;
    }
    const ca = Math.cos(azimuth), sa = Math.sin(azimuth), ce = Math.cos(elevation), se = Math.sin(elevation);
    Object.assign(view, {right: [-sa, ca, 0], up: [-se * ca, -se * sa, ce], toward: [ce * ca, ce * sa, se],
                         scale: (Math.min(width, height) / 2 - room * unit) / scene.radius / 1.1});
    return view;
  }

  function centreAt(scene, view, s) {
    if (!scene.follow.length) return view.middle;
    const at = trackAt(scene, scene.follow, scene.dimension, s);
    return view.middle.map((x, k) => x + at[k]);
  }

  // [x, y, how much larger near things are, how near]
  function project(scene, view, p, centre) {
    if (scene.dimension === 2)
      return [view.across + view.scale * (p[0] - centre[0]), view.down - view.scale * (p[1] - centre[1]), 1, 0];
    let across = 0, up = 0, near = 0;
    for (let k = 0; k < 3; ++k) {
      const x = p[k] - centre[k];
      across += view.right[k] * x;
      up += view.up[k] * x;
      near += view.toward[k] * x;
    }
    const away = awayInRadii * scene.radius, size = away / Math.max(away - near, 0.05 * away);
    return [view.across + view.scale * size * across, view.down - view.scale * size * up, size, near];
  }

  // --------------------------------------------------------------------------------------------------------- strokes

  const det = (x, y, z) =>
    x[0] * (y[1] * z[2] - y[2] * z[1]) - x[1] * (y[0] * z[2] - y[2] * z[0]) + x[2] * (y[0] * z[1] - y[1] * z[0]);
  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const dot = (a, b) => a.reduce((sum, x, k) => sum + x * b[k], 0);

  function sidesOf(e) {
    let seed = 0;
    for (let k = 1; k < 3; ++k) if (Math.abs(e[k]) < Math.abs(e[seed])) seed = k;
    const n = e.map(x => x / hypot(...e)), u = n.map((x, k) => (k === seed ? 1 : 0) - n[seed] * x), size = hypot(...u);
    const first = u.map(x => x / size);
    return [first, cross(n, first)];
  }

  const originSeries = {potential: 0, reaction: 1, spring: 2, weight: 3, torque: 4, applied: 5, damper: 6};
  const forceSeries = e => e.impulse ? 4 : originSeries[e.origin] ?? 1;

  function arrow(from, to, colour, weight, unit) {
    const dx = to[0] - from[0], dy = to[1] - from[1], length = hypot(dx, dy);
    if (!(length >= 4 * unit)) return [];
    const ux = dx / length, uy = dy / length, long = Math.min(8 * Math.sqrt(weight / 1.3) * unit, 0.6 * length),
          half = 0.4 * long;
    const shaft = [from[0], from[1], to[0] - 0.7 * long * ux, to[1] - 0.7 * long * uy];
    return [{kind: 'outline', points: shaft, stroke: colour, width: weight * unit},
            {kind: 'outline', closed: true, fill: colour,
             points: [to[0], to[1], to[0] - long * ux - half * uy, to[1] - long * uy + half * ux,
                      to[0] - long * ux + half * uy, to[1] - long * uy - half * ux]}];
  }
  const words = (text, x, y, align, fill) => ({kind: 'text', points: [x, y], text, align, fill});

  // A whole trail in px stays while the view does.
  const ways = new WeakMap();
  function wayKept(element, view, make) {
    const key = [view.across, view.down, view.scale, view.middle, view.right, view.up].join(), kept = ways.get(element);
    if (kept && kept.key === key) return kept.way;
    const way = make();
    ways.set(element, {key, way});
    return way;
  }

  // Everything of the model at `s` seconds from the first frame. trail: 'none', 'fading' over trailTime seconds,
  // 'whole'.
  function frameItems(scene, view, s, {trail = 'fading', trailTime = 3, trailPieces = 24} = {}) {
    const d = scene.dimension, unit = view.unit, centre = centreAt(scene, view, s), items = [], planes = [], spots = [];
    const eye = d === 3 ? centre.map((x, k) => x + awayInRadii * scene.radius * view.toward[k]) : null;
    const place = p => project(scene, view, p, centre);
    let id = 0;
    const add = item => { items.push({depth: 0, ...item, id: id++}); return items[items.length - 1]; };
    const stroke = (points, colour, weight, depth) =>
      add({kind: 'outline', points, stroke: colour, width: weight * unit, depth});
    const disc = (at, radius, fill, edge, depth) =>
      add({kind: 'disc', points: [at[0], at[1]], radius, fill, stroke: edge, width: 1.4 * unit, depth});
    const lay = (from, depth) => { for (let i = from; i < items.length; ++i) items[i].depth = depth; };
    const note = (at, depth, isTrail = false) => { if (d === 3) spots.push({at, depth, isTrail}); };
    const at = (points, p) => points.slice(p * d, (p + 1) * d);
    const carry = (pose, points, i) => {
      const world = at(pose, 0), origin = at(pose, 0);
      for (let k = 0; k < d; ++k)
        for (let a = 0; a < d; ++a) world[k] += points[i + a] * (pose[(a + 1) * d + k] - origin[k]);
      return world;
    };
    const outline = (pose, points) => {
      const out = [];
      let near = 0;
      for (let i = 0; i < points.length; i += d) {
        const p = place(carry(pose, points, i));
        out.push(p[0], p[1]);
        near += p[3];
      }
      return [out, near / Math.max(1, points.length / d)];
    };

    function path(e, points) {
      const placed = [];
      for (let p = 0; p < e.points; ++p) placed.push(place(at(points, p)));
      if (d === 2 && e.points > 1) stroke(placed.flatMap(p => [p[0], p[1]]), plain('ink'), 2.2, 0);
      for (let p = 0; d === 3 && p + 1 < e.points; ++p) {
        const depth = (placed[p][3] + placed[p + 1][3]) / 2;
        stroke([placed[p][0], placed[p][1], placed[p + 1][0], placed[p + 1][1]], plain('ink'), 2.2, depth);
        note(at(points, p), depth);
        note(at(points, p + 1), depth);
      }
      for (let p = 0; p < e.points; ++p) {
        if (!(e.radii[p] > 0)) continue;
        const radius = Math.max((e.bobs[p] ? 3.5 : 2.6) * unit, view.scale * placed[p][2] * e.radii[p]);
        const depth = placed[p][3] + 1e-3 * scene.radius;
        if (e.bobs[p]) disc(placed[p], radius, series(0), plain('paper'), depth);
        else disc(placed[p], radius, plain('paper'), plain('ink'), depth);
      }
    }

    // How dark a face of a box is, by its normal against the light from above; null where it looks away.
    function shade(pose, face) {
      const [a, b, c] = [0, 3, 6].map(i => carry(pose, face.points, i));
      const n = cross(b.map((x, k) => x - a[k]), c.map((x, k) => x - b[k])), size = hypot(...n);
      if (dot(n, eye.map((x, k) => x - a[k])) <= 0) return null;
      return size > 0 ? bodyTint + 0.12 - 0.2 * Math.max(0, n[2] / size) : bodyTint;
    }

    function notePlane(pose, begin) {
      const origin = at(pose, 0), [u, v] = [1, 2].map(a => at(pose, a).map((x, k) => x - origin[k]));
      const n = cross(u, v), towards = dot(n, eye.map((x, k) => x - origin[k]));
      const length = hypot(...n) * (towards < 0 ? -1 : 1);
      planes.push({begin, end: items.length, origin, normal: n.map(x => x / length), reach: hypot(...u)});
    }

    function order(plane) {
      let behind = -Infinity, before = Infinity, own = items[plane.begin].depth, underTrail = false;
      for (const spot of spots) {
        const side = dot(plane.normal, spot.at.map((x, k) => x - plane.origin[k]));
        if (Math.abs(side) < 0.01 * plane.reach) continue;
        if (spot.isTrail) underTrail = underTrail || side > 0;
        else if (side > 0) before = Math.min(before, spot.depth);
        else behind = Math.max(behind, spot.depth);
      }
      const step = 1e-6 * scene.radius;
      own = Math.min(Math.max(own, behind + step), before - step);
      for (let i = plane.begin; i < plane.end; ++i) items[i].depth = underTrail ? -2e299 : own;
    }

    // The eye sees the unit ball from e = A⁻¹(eye − origin): it touches it where x·e = 1, and what has x·e < 1 is
    // behind it.
    function ball(e, pose, depth, tint) {
      const origin = at(pose, 0), axes = [1, 2, 3].map(a => at(pose, a).map((x, k) => x - origin[k])),
            b = eye.map((x, k) => x - origin[k]);
      const volume = det(...axes),
            local = [0, 1, 2].map(k => det(...axes.map((axis, j) => j === k ? b : axis)) / volume);
      const square = dot(local, local);
      if (!(square > 1)) return;
      const [u, v] = sidesOf(local), r = Math.sqrt(1 - 1 / square), rim = [];
      for (let i = 0; i < contour; ++i) {
        const angle = 2 * Math.PI * i / contour;
        for (let k = 0; k < 3; ++k) rim.push(local[k] / square + r * (Math.cos(angle) * u[k] + Math.sin(angle) * v[k]));
      }
      Object.assign(stroke(outline(pose, rim)[0], plain(tint === 1 ? 'paper' : 'ink'), 1.6, depth),
                    {closed: true, fill: series(0, tint)});
      for (const line of e.lines) {
        const n = line.points.length / 3, point = i => line.points.slice(i % n * 3, i % n * 3 + 3),
              seen = i => dot(point(i), local) >= 1;
        let first = 0;
        while (first < n && !(seen(first + 1) && !seen(first))) ++first;
        const half = [];
        for (let i = first + 1; i <= first + n && seen(i); ++i) half.push(...point(i));
        if (half.length < 6) ++id;
        else stroke(outline(pose, withPoints(half, 25))[0], plain('ink', 0.6), 1, depth);
      }
    }

    function solid(e, pose) {
      const origin = place(at(pose, 0));
      let reach = 0;
      for (let a = 1; a <= d; ++a) {
        const tip = place(at(pose, a));
        reach = Math.max(reach, hypot(tip[0] - origin[0], tip[1] - origin[1]));
      }
      const round = e.ball || (e.faces.length && e.faces[0].points.length > 4 * d);
      if (!e.ground && round && reach < 3 * unit) {
        ++id;
        return disc(origin, 3 * unit, series(0), plain('paper'), origin[3]);
      }
      const begin = items.length, small = round && !e.lines.length && reach < 14 * unit;
      if (e.ball) {
        note(at(pose, 0), origin[3]);
        return ball(e, pose, origin[3], small ? 1 : bodyTint);
      }
      for (const face of e.faces) {
        const tint = e.convex ? shade(pose, face) : small ? 1 : bodyTint;
        if (tint === null) { ++id; continue; }
        const edge = plain(small ? 'paper' : e.ground ? 'muted' : 'ink');
        Object.assign(stroke(outline(pose, face.points)[0], edge, e.ground ? 1.2 : 1.6, origin[3]),
                      {closed: true, fill: e.ground ? plain('paper') : series(0, tint)});
      }
      const grid = e.ground && d === 3, bare = !e.faces.length;
      for (const line of e.lines) {
        const [points, near] = outline(pose, line.points);
        const colour = grid ? plain('muted', 0.3) : plain(e.ground ? 'muted' : 'ink');
        const weight = e.ground ? 1 : bare ? (line.closed ? 2.2 : 1.6) : 1.1;
        stroke(points, colour, weight, bare && !grid ? near : origin[3]).closed = line.closed;
      }
      if (d === 3 && !e.ground && !bare && !e.convex) notePlane(pose, begin);
      else if (d === 3 && !e.ground) note(at(pose, 0), origin[3]);
    }

    function trailOf(e, colour) {
      if (trail === 'none') return;
      const whole = trail === 'whole', all = duration(scene);
      const way = (from, to, steps) => {
        const line = [];
        for (let i = 0; i <= steps; ++i) {
          const p = pointsAt(scene, e, from + (to - from) * i / steps);
          if (!finite(p)) continue;
          const q = place(p);
          line.push(q[0], q[1]);
        }
        return line;
      };
      const now = pointsAt(scene, e, s);
      if (Number.isFinite(now[0])) note(now, 0, true);
      const steps = Math.min(1500, Math.max(2, scene.times.length));
      if (!scene.follow.length)
        stroke(wayKept(e, view, () => thinned(way(0, all, steps), 0.7)),
               series(colour, whole ? 0.75 : wholeTrail), whole ? 1.4 : 1, -1e299);
      if (whole) return;
      const from = Math.max(0, s - trailTime);
      for (let k = 0; k < trailPieces; ++k) {
        const part = (k + 1) / trailPieces;
        const begin = from + (s - from) * k / trailPieces, pieces = Math.max(4, Math.floor(192 / trailPieces));
        stroke(way(begin, from + (s - from) * part, pieces),
               series(colour, 0.1 + 0.85 * part ** 1.5), 1.2 + 0.9 * part, -1e298);
      }
    }

    function force(e, points) {
      const last = e.points - 1, colour = series(forceSeries(e));
      if (last > 1) { // an arc, whose last piece has the head
        const way = [];
        for (let p = 0; p < last; ++p) way.push(...place(at(points, p)).slice(0, 2));
        stroke(way, colour, 2.2, 0);
      }
      const [foot, tip] = [last - 1, last].map(p => place(at(points, p)));
      for (const item of arrow(foot, tip, colour, 2.2, unit)) add(item);
      const dx = tip[0] - foot[0], dy = tip[1] - foot[1], length = hypot(dx, dy), gap = 14 * unit;
      if (length <= 24 * unit || !e.text.base) return;
      const align = dy > 0.3 * length ? 'r' : dy < -0.3 * length ? 'l' : 'c';
      add(words(e.text, tip[0] - gap * dy / length, tip[1] + gap * dx / length, align, plain('muted')));
    }

    let trails = 0;
    scene.elements.forEach((e, i) => {
      id = i * idsOfAnElement;
      if (e.kind === 'trail') return trailOf(e, 1 + trails++ % 6);
      const points = pointsAt(scene, e, s), begin = items.length;
      if (!finite(points)) return;
      if (e.kind === 'path') path(e, points);
      else if (e.kind === 'solid') solid(e, points);
      else if (e.kind === 'arrow') force(e, points);
      else {
        const p = place(points), gap = 14 * unit;
        add(words(e.text, p[0] + 0.8 * gap, p[1] - gap, 'l', plain('ink')));
      }
      if (e.kind === 'solid' && e.ground) lay(begin, -1e300);
      if (e.kind === 'arrow' || e.kind === 'label') lay(begin, 1e300);
    });
    planes.forEach(order);
    if (d === 3) items.sort((a, b) => a.depth - b.depth);
    return items;
  }

  // The same line in space by this number of points.
  function withPoints(line, count) {
    const out = [], n = line.length / 3;
    for (let i = 0; i < count; ++i) {
      const at = i * (n - 1) / (count - 1), k = Math.min(Math.floor(at), n - 2);
      for (let c = 0; c < 3; ++c) out.push(line[3 * k + c] + (at - k) * (line[3 * k + 3 + c] - line[3 * k + c]));
    }
    return out;
  }

  function thinned(line, step) {
    const out = [];
    for (let i = 0; i + 1 < line.length; i += 2) {
      const ends = i === 0 || i + 2 === line.length;
      if (!ends && hypot(line[i] - out[out.length - 2], line[i + 1] - out[out.length - 1]) < step) continue;
      out.push(line[i], line[i + 1]);
    }
    return out;
  }

  // ------------------------------------------------------------------------------------------------------- furniture

  function lengthText(scene, size) {
    if (scene.dimensionless) return String(Number(size.toPrecision(2)));
    const units =
      [[1e9, 'Gm'], [1e6, 'Mm'], [1e3, 'km'], [1, 'm'], [1e-2, 'cm'], [1e-3, 'mm'], [1e-6, 'µm'], [1e-9, 'nm']];
    const [factor, unit] = units.find(([f]) => size >= f * 0.999) || units[units.length - 1];
    const number = Number((size / factor).toPrecision(2));
    return number < 1e5 ? `${number} ${unit}` : `${size.toExponential(0)} m`;
  }

  function scaleBar(scene, view) {
    const u = view.unit, wanted = 90 * u / view.scale, power = 10 ** Math.floor(Math.log10(wanted));
    const size = [5, 2, 1].map(f => f * power).find(f => f <= wanted) ?? power;
    const x = 18 * u, y = view.height - 16 * u, end = x + size * view.scale;
    return [{kind: 'outline', points: [x, y - 4 * u, x, y, end, y, end, y - 4 * u], stroke: plain('muted'), width: u},
            words({base: lengthText(scene, size), index: '', upright: true}, end + 7 * u, y - 3 * u, 'l',
                  plain('muted'))];
  }

  function gravityArrow(scene, view) {
    const norm = hypot(...scene.gravity);
    if (!(norm > 0)) return [];
    const centre = view.middle, tip = centre.map((x, k) => x + scene.gravity[k] / norm * scene.radius);
    const from = project(scene, view, centre, centre), to = project(scene, view, tip, centre);
    const dx = to[0] - from[0], dy = to[1] - from[1], length = hypot(dx, dy), u = view.unit;
    if (!(length > 0)) return [];
    const size = Math.min(34, 34 * length / (view.scale * scene.radius) + 8) * u, x = view.width - 30 * u, y = 26 * u;
    return [...arrow([x, y], [x + dx / length * size, y + dy / length * size], plain('muted'), 1.3, u),
            words({base: 'g', index: ''}, x + dx / length * size / 2 - 11 * u * Math.abs(dy / length),
                  y + dy / length * size / 2 - 11 * u * Math.abs(dx / length), 'c', plain('muted'))];
  }

  function axes(scene, view) {
    const centre = view.middle, origin = project(scene, view, centre, centre), u = view.unit;
    const x = 44 * u, y = view.height - 40 * u, step = 0.05 * scene.radius;
    return ['x', 'y', 'z'].flatMap((name, k) => {
      const at = project(scene, view, centre.map((value, j) => value + (j === k ? step : 0)), centre);
      const dx = (at[0] - origin[0]) / (step * view.scale), dy = (at[1] - origin[1]) / (step * view.scale);
      const shaft = arrow([x, y], [x + 27 * u * dx, y + 27 * u * dy], plain('muted'), 1.2, u);
      if (!(hypot(dx, dy) > 0.15)) return shaft;
      return [...shaft, words({base: name, index: ''}, x + 36 * u * dx, y + 36 * u * dy, 'c', plain('muted'))];
    });
  }

  const furniture = (scene, view) =>
    [...(scene.dimension === 2 ? scaleBar(scene, view) : axes(scene, view)), ...gravityArrow(scene, view)];

  return {duration, direction, makeView, frameItems, furniture, pointsAt, centreAt, project, forceSeries};
})();
if (typeof module !== 'undefined') module.exports = maupScene;
