// The strokes of scene.js on a canvas, in the colours of the page's style sheet.
'use strict';
function maupPainter(context) {
  const channels = text => {
    context.fillStyle = '#000';
    context.fillStyle = text;  // any colour of a style sheet, as #rrggbb
    return [1, 3, 5].map(i => parseInt(context.fillStyle.slice(i, i + 2), 16));
  };
  let palette = {}, tint = null;
  function readColours() {
    const colour = name => channels(getComputedStyle(document.documentElement).getPropertyValue(name).trim());
    palette = {ink: colour('--ink'), muted: colour('--muted'), paper: colour('--figure'),
               series: [1, 2, 3, 4, 5, 6, 7].map(i => colour(`--series-${i}`))};
  }
  const inkOf = colour => colour.ink === 'paper' ? palette.paper : tint !== null ? palette.series[tint] :
      colour.ink === 'series' ? palette.series[colour.series] : palette[colour.ink];
  const tintOf = (x, k, strength) => Math.round(palette.paper[k] + strength * (x - palette.paper[k]));
  const fillOf = colour => `rgb(${inkOf(colour).map((x, k) => tintOf(x, k, colour.strength)).join()})`;

  // `unit`: of the view that made the strokes. With `only`, everything has the colour of that series, as a ghost has.
  function paint(items, unit, {opacity = 1, only = null} = {}) {
    tint = only;
    context.lineJoin = 'round';
    for (const item of items) {
      const [x, y] = item.points;
      context.globalAlpha = opacity;
      if (item.kind === 'text') { write(item, x, y, unit); continue; }
      context.beginPath();
      if (item.kind === 'disc') context.arc(x, y, item.radius, 0, 2 * Math.PI);
      else for (let i = 0; i < item.points.length; i += 2) context.lineTo(item.points[i], item.points[i + 1]);
      if (item.closed) context.closePath();
      if (item.fill) {
        context.fillStyle = fillOf(item.fill);
        context.fill();
      }
      if (!item.stroke) continue;
      context.globalAlpha = opacity * item.stroke.strength;
      // Round ends would show as beads where pieces meet.
      context.lineCap = item.stroke.strength < 1 ? 'butt' : 'round';
      context.strokeStyle = `rgb(${inkOf(item.stroke).join()})`;
      context.lineWidth = item.width;
      context.stroke();
    }
    context.globalAlpha = 1;
  }

  function write(item, x, y, unit) {
    const {base, index, upright, dots = 0} = item.text, size = 15 * unit;
    const faces = "'STIX Two Text','Latin Modern Roman','Cambria','Times New Roman','DejaVu Serif',serif";
    const large = `${upright ? '' : 'italic '}${size}px ${faces}`, small = `${0.72 * size}px ${faces}`;
    const word = base + '\u0307'.repeat(dots);
    context.font = small;
    const tail = context.measureText(index).width;
    context.font = large;
    const whole = context.measureText(word).width + tail;
    const left = item.align === 'l' ? x : item.align === 'r' ? x - whole : x - whole / 2;
    context.fillStyle = fillOf(item.fill);
    context.textAlign = 'left';
    context.textBaseline = 'alphabetic';
    context.fillText(word, left, y + 0.33 * size);
    context.font = small;
    context.fillText(index, left + whole - tail, y + 0.55 * size);
  }

  return {readColours, paint};
}
