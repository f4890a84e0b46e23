// The drawings of a report: each figure names the element with its frames, data-drawing. They are drawn on its canvas; the
// reader plays, pauses, scrubs, changes the speed, and turns a drawing in space, as far as the figure has controls. A mode
// (data-loop) swings without end over its equilibrium. Nothing is fetched.
'use strict';
function animate(figure, scene) {
  const loops = 'loop' in figure.dataset;
  const canvas = figure.querySelector('canvas');
  let context = canvas.getContext('2d');
  const control = name => figure.querySelector(`[data-control="${name}"]`);
  const {dimension, times, elements} = scene;
  for (const element of elements) element.positions = element.positions.map(value => value ?? NaN);
  const spatial = dimension === 3;
  const duration = Math.abs(times[times.length - 1] - times[0]), direction = times[times.length - 1] < times[0] ? -1 : 1;

  // ------------------------------------------------------------------------------------------------ motion in time

  // The frame before the elapsed time s, by bisection.
  function frameBefore(s) {
    let low = 0, high = times.length - 1;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (direction * (times[middle] - times[0]) <= s) low = middle; else high = middle;
    }
    return low;
  }

  // Cubic interpolation through the neighbouring frames (Catmull-Rom on uneven times): smooth between frames, exact at
  // each. `width` numbers a frame.
  function interpolate(track, width, s) {
    const i = frameBefore(s), result = new Array(width), last = times.length - 1;
    const at = k => direction * (times[k] - times[0]);
    if (last === 0) return track.slice(0, width);
    const h = at(i + 1) - at(i), u = h > 0 ? Math.min(1, Math.max(0, (s - at(i)) / h)) : 0;
    for (let k = 0; k < width; ++k) {
      const value = f => track[f * width + k];
      const p = value(i), q = value(i + 1);
      const slope = f => f <= 0 || f >= last ? null : (value(f + 1) - value(f - 1)) / (at(f + 1) - at(f - 1)) * h;
      const chord = q - p;
      const m = slope(i) ?? chord, n = slope(i + 1) ?? chord;
      const v = 1 - u;
      result[k] = u === 0 ? p : u === 1 ? q : p * (1 + 2 * u) * v * v + q * (3 - 2 * u) * u * u + m * u * v * v - n * u * u * v;
    }
    return result;
  }

  // --------------------------------------------------------------------------------------------------------- camera

  // Everything that ever appears, as a box in the world.
  function sceneBounds() {
    const low = new Array(dimension).fill(Infinity), high = new Array(dimension).fill(-Infinity);
    for (const element of elements) {
      const width = element.points * dimension;
      for (let i = 0; i < element.positions.length; ++i) {
        const value = element.positions[i], axis = i % dimension;
        if (!Number.isFinite(value)) continue;
        const frame = Math.floor(i / width);
        const reach = element.sizes.length ? reachOf(element, frame) : 0;
        low[axis] = Math.min(low[axis], value - reach);
        high[axis] = Math.max(high[axis], value + reach);
      }
    }
    for (let k = 0; k < dimension; ++k) if (!(low[k] <= high[k])) low[k] = high[k] = 0;
    return {low, high};
  }
  function reachOf(element, frame) {
    const count = element.kind === 'box' ? 2 : 1, sizes = element.sizes.slice(frame * count, frame * count + count);
    return element.kind === 'box' ? Math.hypot(sizes[0], sizes[1]) / 2 : Math.abs(sizes[0]);
  }

  // The greatest distance of any point from the middle.
  function farthest() {
    let greatest = 0;
    for (const {positions} of elements)
      for (let i = 0; i + dimension <= positions.length; i += dimension) {
        const distance = Math.hypot(...middle.map((value, k) => positions[i + k] - value));
        if (distance > greatest) greatest = distance;
      }
    return greatest;
  }

  const bounds = sceneBounds();
  const middle = bounds.low.map((low, k) => (low + bounds.high[k]) / 2);
  const extent = bounds.low.map((low, k) => bounds.high[k] - low);
  const radius = farthest() || Math.hypot(...extent) / 2 || 1;
  const view = {azimuth: -0.9, elevation: 0.32, zoom: 1};
  let width = 0, height = 0, scale = 1, centre = [0, 0];

  function fit() {
    const ratio = window.devicePixelRatio || 1, box = canvas.getBoundingClientRect();
    width = box.width;
    height = box.height;
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.lineCap = context.lineJoin = 'round';
    const room = 28, strip = scene.gravity.length && !spatial ? 34 : 0;  // beside the drawing, for the arrow of gravity
    if (spatial) scale = (Math.min(width, height) / 2 - room) / radius / 1.1;
    else scale = Math.min((width - 2 * room - strip) / (extent[0] || radius), (height - 2 * room) / (extent[1] || radius));
    if (!Number.isFinite(scale) || scale <= 0) scale = 1;
    centre = [(width - strip) / 2, height / 2];
  }

  // World → canvas; in space by a camera that stands six radii away, so that near things are a little larger.
  function project(p) {
    if (!spatial) return [centre[0] + scale * (p[0] - middle[0]), centre[1] - scale * (p[1] - middle[1]), 1];
    const [x, y, z] = p.map((value, k) => value - middle[k]);
    const ca = Math.cos(view.azimuth), sa = Math.sin(view.azimuth), ce = Math.cos(view.elevation), se = Math.sin(view.elevation);
    const right = -sa * x + ca * y, away = ca * x + sa * y;
    const up = ce * z - se * away, near = se * z + ce * away;
    const size = 6 * radius / (6 * radius - near) * view.zoom;
    return [centre[0] + scale * size * right, centre[1] - scale * size * up, size];
  }

  // -------------------------------------------------------------------------------------------------------- drawing

  const colour = name => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  let palette = {};
  function readColours() {
    palette = {ink: colour('--ink'), muted: colour('--muted'), grid: colour('--grid'), paper: colour('--figure'),
               series: [1, 2, 3, 4, 5, 6, 7].map(i => colour(`--series-${i}`))};
  }

  const finite = p => p.every(Number.isFinite);
  function pointsAt(element, s) {
    const flat = interpolate(element.positions, element.points * dimension, s), points = [];
    for (let i = 0; i < element.points; ++i) points.push(flat.slice(i * dimension, (i + 1) * dimension));
    return points;
  }

  function stroke(points, style, lineWidth) {
    context.beginPath();
    points.forEach((p, i) => i ? context.lineTo(p[0], p[1]) : context.moveTo(p[0], p[1]));
    context.strokeStyle = style;
    context.lineWidth = lineWidth;
    context.stroke();
  }

  function disc(p, r, fill, edge) {
    context.beginPath();
    context.arc(p[0], p[1], r, 0, 2 * Math.PI);
    context.fillStyle = fill;
    context.fill();
    if (edge) {
      context.strokeStyle = edge;
      context.lineWidth = 1.5;
      context.stroke();
    }
  }

  const heaviest = Math.max(0, ...elements.flatMap(element => element.masses));
  const bobRadius = mass => Math.min(11, Math.max(4, 9 * Math.cbrt(mass / heaviest)));

  // The end of a rod or spring: a bob where it has mass, a joint where it has none.
  function drawEnd(p, mass) {
    if (mass > 0) disc(p, bobRadius(mass) * p[2], palette.series[0], palette.paper);
    else disc(p, 3, palette.paper, palette.ink);
  }

  function drawLine(element, s) {
    const points = pointsAt(element, s);
    if (!points.every(finite)) return;
    const placed = points.map(project);
    stroke(placed, palette.ink, 2);
    placed.forEach((p, i) => drawEnd(p, element.masses[i] || 0));
  }

  // A coil seen from the side: straight ends, then a circle that moves along. Its windings part as the spring is drawn
  // out and overlap as it is pressed together.
  function drawSpring(element, s) {
    const ends = pointsAt(element, s);
    if (!ends.every(finite)) return;
    const [a, b] = ends.map(project), dx = b[0] - a[0], dy = b[1] - a[1], length = Math.hypot(dx, dy);
    if (length < 1e-6) return;
    const windings = windingsOf(element), reach = Math.min(9, 0.3 * length), lead = Math.min(14, 0.15 * length);
    const along = [dx / length, dy / length];
    const at = (u, v) => [a[0] + along[0] * u - along[1] * v, a[1] + along[1] * u + along[0] * v];
    const points = [a], steps = windings * 20;
    for (let i = 0; i <= steps; ++i) {
      const phase = 2 * Math.PI * windings * i / steps, ends = Math.sin(Math.PI * i / steps) ** 0.25;
      points.push(at(lead + (length - 2 * lead) * i / steps - 0.5 * reach * (1 - Math.cos(phase)) * ends + 0.5 * reach * ends, reach * Math.sin(phase)));
    }
    points.push(b);
    stroke(points, palette.ink, 1.5);
    [a, b].forEach((p, i) => drawEnd(p, element.masses[i] || 0));
  }

  // As many as look right at the mean length.
  function windingsOf(element) {
    if (element.windings) return element.windings;
    let sum = 0, count = 0;
    for (let f = 0; f < times.length; ++f) {
      const p = element.positions.slice(2 * f * dimension, 2 * (f + 1) * dimension);
      const length = Math.hypot(...p.slice(0, dimension).map((value, k) => value - p[dimension + k]));
      if (Number.isFinite(length)) { sum += length; ++count; }
    }
    return element.windings = Math.round(Math.min(22, Math.max(6, count ? sum / count * scale / 17 : 10)));
  }

  function drawBox(element, s) {
    const [p] = pointsAt(element, s);
    if (!finite(p)) return;
    const [w, h] = interpolate(element.sizes, 2, s);
    const angle = element.rotation.length ? interpolate(element.rotation, 1, s)[0] : 0;
    const corners = [[-1, -1], [1, -1], [1, 1], [-1, 1]].map(([u, v]) => {
      const x = u * w / 2, y = v * h / 2, c = Math.cos(angle), n = Math.sin(angle);
      return project(spatial ? [p[0] + x, p[1], p[2] + y] : [p[0] + c * x - n * y, p[1] + n * x + c * y]);
    });
    context.beginPath();
    corners.forEach((q, i) => i ? context.lineTo(q[0], q[1]) : context.moveTo(q[0], q[1]));
    context.closePath();
    fillBody();
  }

  // Bodies with an extent are outlines over a tint.
  function fillBody() {
    context.globalAlpha = 0.22;
    context.fillStyle = palette.series[0];
    context.fill();
    context.globalAlpha = 1;
    context.strokeStyle = palette.ink;
    context.lineWidth = 1.6;
    context.stroke();
  }

  function drawCircle(element, s) {
    const [p] = pointsAt(element, s);
    if (!finite(p)) return;
    const placed = project(p), [r] = interpolate(element.sizes, 1, s);
    const size = Math.max(3, scale * Math.abs(r) * placed[2]);
    if (size < 14) return disc(placed, size, palette.series[0], palette.paper);
    context.beginPath();
    context.arc(placed[0], placed[1], size, 0, 2 * Math.PI);
    fillBody();
  }

  // The path of the last seconds fades into the past, over a hint of the whole way.
  function drawTrail(element, s, index) {
    const style = palette.series[(index + 1) % palette.series.length], fade = trailSeconds(), parts = 400;
    if (fade === 0) return;
    context.globalAlpha = 0.16;
    context.strokeStyle = style;
    context.lineWidth = 1;
    context.stroke(wholeWay(element));
    context.lineCap = 'butt';  // round ends would show as beads where pieces meet
    const from = Math.max(0, s - fade);
    let last = null;
    for (let i = 0; i <= parts; ++i) {
      const [p] = pointsAt(element, from + (s - from) * i / parts), next = finite(p) ? project(p) : null;
      context.globalAlpha = fade >= duration ? 0.8 : 0.05 + 0.95 * (i / parts) ** 1.5;
      if (last && next) stroke([last, next], style, 2);
      last = next;
    }
    context.globalAlpha = 1;
    context.lineCap = 'round';
  }

  // The whole way of a point as a path, made anew when the view changes.
  function wholeWay(element) {
    const key = [view.azimuth, view.elevation, scale, ...centre].join();
    if (element.wayKey === key) return element.way;
    const path = new Path2D();
    let drawing = false;
    for (let f = 0; f < times.length; ++f) {
      const p = element.positions.slice(f * dimension, (f + 1) * dimension);
      const placed = finite(p) ? project(p) : null;
      if (placed) drawing ? path.lineTo(placed[0], placed[1]) : path.moveTo(placed[0], placed[1]);
      drawing = placed !== null;
    }
    element.wayKey = key;
    return element.way = path;
  }

  function trailSeconds() {
    const choice = control('trail')?.value ?? 'none';
    return choice === 'all' ? duration : choice === 'none' ? 0 : Math.min(duration, 3 * rate());
  }

  function arrow(from, to, style, weight = 1.3) {
    const dx = to[0] - from[0], dy = to[1] - from[1], length = Math.hypot(dx, dy);
    if (length < 4) return;
    const u = [dx / length, dy / length];
    stroke([from, [to[0] - 5 * u[0], to[1] - 5 * u[1]]], style, weight);
    context.beginPath();
    const long = 8 * Math.sqrt(weight / 1.3), half = 0.4 * long;
    context.moveTo(to[0], to[1]);
    context.lineTo(to[0] - long * u[0] - half * u[1], to[1] - long * u[1] + half * u[0]);
    context.lineTo(to[0] - long * u[0] + half * u[1], to[1] - long * u[1] - half * u[0]);
    context.closePath();
    context.fillStyle = style;
    context.fill();
  }

  function label(text, x, y, align) {
    context.fillStyle = palette.muted;
    context.font = "italic 14px 'STIX Two Text','Latin Modern Roman','Cambria','Times New Roman','DejaVu Serif',serif";
    context.textAlign = align || 'center';
    context.textBaseline = 'middle';
    context.fillText(text, x, y);
  }

  // A scale bar of 1, 2 or 5 times a power of ten of metres.
  function drawScaleBar() {
    const wanted = 90 / scale, power = 10 ** Math.floor(Math.log10(wanted));
    const size = [5, 2, 1].map(f => f * power).find(f => f <= wanted) ?? power;
    const x = 18, y = height - 16, end = x + size * scale;
    stroke([[x, y - 4], [x, y], [end, y], [end, y - 4]], palette.muted, 1);
    context.fillStyle = palette.muted;
    context.font = "12px 'STIX Two Text','Latin Modern Roman','Cambria','Times New Roman','DejaVu Serif',serif";
    context.textAlign = 'left';
    context.textBaseline = 'alphabetic';
    context.fillText(lengthText(size), end + 7, y + 1);
  }
  function lengthText(size) {
    if (scene.dimensionless) return String(Number(size.toPrecision(2)));
    const units = [[1e9, 'Gm'], [1e6, 'Mm'], [1e3, 'km'], [1, 'm'], [1e-2, 'cm'], [1e-3, 'mm'], [1e-6, 'µm'], [1e-9, 'nm']];
    const [factor, unit] = units.find(([f]) => size >= f * 0.999) || units[units.length - 1];
    const number = Number((size / factor).toPrecision(2));
    return number < 1e5 ? `${number} ${unit}` : `${size.toExponential(0)} m`;
  }

  function drawGravity() {
    if (!scene.gravity.length) return;
    const norm = Math.hypot(...scene.gravity);
    if (!(norm > 0)) return;
    const tip = scene.gravity.map((g, k) => middle[k] + g / norm * radius);
    const from = project(middle), to = project(tip), length = Math.hypot(to[0] - from[0], to[1] - from[1]) || 1;
    const u = [(to[0] - from[0]) / length, (to[1] - from[1]) / length], size = Math.min(34, 34 * length / (scale * radius) + 8);
    const foot = [width - 30, 30], head = [foot[0] + u[0] * size, foot[1] + u[1] * size];
    arrow(foot, head, palette.muted);
    label('g', (foot[0] + head[0]) / 2 - 11 * Math.abs(u[1]) - 2, (foot[1] + head[1]) / 2 - 11 * Math.abs(u[0]));
  }

  // In space: a floor below everything and the three axes at the corner, so that a turn of the view is seen as one.
  function drawFloor() {
    const z = bounds.low[2], reach = Math.max(extent[0], extent[1], 0.4 * radius) * 0.6, lines = 8;
    for (let i = -lines / 2; i <= lines / 2; ++i) {
      const d = 2 * reach * i / lines;
      stroke([[d, -reach], [d, reach]].map(([x, y]) => project([middle[0] + x, middle[1] + y, z])), palette.grid, 1);
      stroke([[-reach, d], [reach, d]].map(([x, y]) => project([middle[0] + x, middle[1] + y, z])), palette.grid, 1);
    }
    const origin = project(middle), foot = [42, 46];
    ['x', 'y', 'z'].forEach((name, k) => {
      const tip = project(middle.map((value, j) => value + (j === k ? 0.5 * radius : 0)));
      const u = [(tip[0] - origin[0]) / (0.5 * radius * scale * view.zoom), (tip[1] - origin[1]) / (0.5 * radius * scale * view.zoom)];
      const head = [foot[0] + 28 * u[0], foot[1] + 28 * u[1]];
      arrow(foot, head, palette.muted);
      label(name, foot[0] + 37 * u[0], foot[1] + 37 * u[1]);
    });
  }

  // The force of a constraint on a point, named at its tip.
  function drawReaction(element, s) {
    const ends = pointsAt(element, s);
    if (!ends.every(finite)) return;
    const [foot, tip] = ends.map(project), style = palette.series[1];
    arrow(foot, tip, style, 2.2);
    const dx = tip[0] - foot[0], dy = tip[1] - foot[1], length = Math.hypot(dx, dy);
    if (length > 24) label(element.name, tip[0] - 14 * dy / length, tip[1] + 14 * dx / length, dy > 0.3 * length ? 'right' : dy < -0.3 * length ? 'left' : 'center');
  }

  const painters = {reaction: drawReaction, line: drawLine, spring: drawSpring, box: drawBox, circle: drawCircle};
  function draw() {
    context.clearRect(0, 0, width, height);
    if (spatial && !loops) drawFloor();
    elements.forEach((element, i) => element.kind === 'trail' && drawTrail(element, elapsed, i));
    if (loops) drawEquilibrium();
    for (const last of [false, true])  // forces over everything else
      elements.forEach(element => element.kind !== 'trail' && (element.kind === 'reaction') === last && painters[element.kind](element, elapsed));
    if (loops) return;
    drawGravity();
    if (!spatial) drawScaleBar();
  }

  // A mode passes its equilibrium a quarter of a period after its turning point.
  function drawEquilibrium() {
    const faded = document.createElement('canvas');
    faded.width = canvas.width;
    faded.height = canvas.height;
    const screen = context;
    context = faded.getContext('2d');
    context.setTransform(screen.getTransform());
    context.lineCap = context.lineJoin = 'round';
    elements.forEach(element => element.kind !== 'trail' && element.kind !== 'reaction' && painters[element.kind](element, duration / 4));
    context = screen;
    context.save();
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.globalAlpha = 0.2;
    context.drawImage(faded, 0, 0);
    context.restore();
  }

  // ------------------------------------------------------------------------------------------------------- controls

  let elapsed = 0, playing = false, before = 0;
  const now = () => times[0] + direction * elapsed;
  const digits = Math.max(0, Math.min(9, 3 - Math.floor(Math.log10(duration || 1))));
  const rate = () => Number(control('speed')?.value ?? figure.dataset.rate);

  function show() {
    draw();
    const text = `${now().toFixed(digits)}${scene.dimensionless ? '' : ' s'}`;
    if (!loops) {
      control('time').textContent = text;
      control('scrub').value = duration > 0 ? String(elapsed / duration) : '0';
      control('scrub').setAttribute('aria-valuetext', `t = ${text}`);
    }
    control('play')?.setAttribute('aria-label', playing ? 'Pause' : 'Play');
    figure.dataset.time = String(now());
    figure.dataset.state = playing ? 'playing' : 'paused';
  }

  function step(stamp) {
    if (!playing) return;
    elapsed = Math.min(duration, elapsed + Math.min(0.1, (stamp - before) / 1000) * rate());
    before = stamp;
    if (elapsed >= duration) loops ? elapsed = 0 : playing = false;
    show();
    if (playing) requestAnimationFrame(step);
  }

  function play(on) {
    if (on === playing) return;
    playing = on;
    if (playing) {
      if (elapsed >= duration) elapsed = 0;
      before = performance.now();
      requestAnimationFrame(step);
    }
    show();
  }

  function seek(s) {
    elapsed = Math.min(duration, Math.max(0, s));
    show();
  }

  // Speeds around the one at which a run takes a pleasant time to watch.
  function offerSpeeds() {
    const pleasant = duration >= 2 && duration <= 120 ? 1 : 10 ** Math.round(Math.log10(duration / 15 || 1));
    const select = control('speed');
    if (!select) return;
    for (const factor of [0.1, 0.25, 0.5, 1, 2, 5, 10]) {
      const option = document.createElement('option'), speed = pleasant * factor;
      option.value = String(speed);
      option.textContent = '× ' + speedText(Number(speed.toPrecision(2)));
      option.selected = factor === 1;
      select.append(option);
    }
  }

  function speedText(speed) {
    if (speed >= 1e-3 && speed < 1e6) return speed.toLocaleString('en');
    const [mantissa, exponent] = speed.toExponential().split('e');
    const raised = [...exponent.replace('+', '')].map(c => '⁻⁰¹²³⁴⁵⁶⁷⁸⁹'['-0123456789'.indexOf(c)]).join('');
    return (mantissa === '1' ? '' : mantissa + ' · ') + '10' + raised;
  }

  function onKey(event) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (/^(INPUT|SELECT|TEXTAREA|SUMMARY|A)$/.test(event.target.tagName) && event.target !== control('scrub')) return;
    const small = duration / 200, large = duration / 20;
    const actions = {
      ' ': () => play(!playing),
      ArrowRight: () => seek(elapsed + (event.shiftKey ? large : small)),
      ArrowLeft: () => seek(elapsed - (event.shiftKey ? large : small)),
      Home: () => event.target !== document.body && seek(0),
      End: () => event.target !== document.body && seek(duration),
    };
    const action = actions[event.key];
    if (!action || (event.key === ' ' && event.target.tagName === 'BUTTON')) return;
    if (action() === false) return;
    event.preventDefault();
  }

  function turnByPointer() {
    let last = null;
    canvas.addEventListener('pointerdown', event => {
      last = [event.clientX, event.clientY];
      canvas.setPointerCapture(event.pointerId);
    });
    canvas.addEventListener('pointermove', event => {
      if (!last) return;
      view.azimuth -= (event.clientX - last[0]) * 0.01;
      view.elevation = Math.min(1.57, Math.max(-1.57, view.elevation + (event.clientY - last[1]) * 0.01));
      last = [event.clientX, event.clientY];
      show();
    });
    for (const end of ['pointerup', 'pointercancel']) canvas.addEventListener(end, () => { last = null; });
    canvas.addEventListener('dblclick', () => {
      Object.assign(view, {azimuth: -0.9, elevation: 0.32, zoom: 1});
      show();
    });
  }

  readColours();
  offerSpeeds();
  control('play')?.addEventListener('click', () => play(!playing));
  if (!loops) {
    control('scrub').addEventListener('input', event => { play(false); seek(Number(event.target.value) * duration); });
    control('trail').addEventListener('change', show);
    control('trail').closest('label').hidden = !elements.some(element => element.kind === 'trail');
    document.addEventListener('keydown', onKey);
  }
  if (spatial) {
    figure.classList.add('spatial');
    turnByPointer();
  }
  const redraw = () => { readColours(); fit(); show(); };
  new ResizeObserver(redraw).observe(canvas);
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', redraw);
  document.addEventListener('maup-theme', redraw);
  redraw();
  if (loops && matchMedia('(prefers-reduced-motion: no-preference)').matches) play(true);
}

for (const figure of document.querySelectorAll('figure[data-drawing]'))
  animate(figure, JSON.parse(document.getElementById(figure.dataset.drawing).textContent));
