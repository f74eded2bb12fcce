// Elements, numbers and colours of the page.
'use strict';

const kRed = [[0, [128, 12, 38]], [0.2, [196, 62, 60]], [0.36, [236, 150, 116]], [0.5, [243, 240, 232]]];
const kBlue = [[0.64, [142, 186, 217]], [0.8, [62, 124, 182]], [1, [14, 52, 106]]];
const kDiverging = kRed.concat(kBlue);
const kLeftOnly = [[0, [243, 240, 232]], [0.28, [142, 186, 217]], [0.6, [62, 124, 182]], [1, [14, 52, 106]]];
const kDeepOnly = [[0, [128, 12, 38]], [0.4, [196, 62, 60]], [0.72, [236, 150, 116]], [1, [243, 240, 232]]];

const byId = (id) => document.getElementById(id);
const minus = (text) => text.replace('-', '\u2212');
const number = (v, digits = 3) => minus(String(Number(v.toPrecision(digits))));
const fixed = (v, decimals) => minus((Math.abs(v) < 0.5 * 10 ** -decimals ? 0 : v).toFixed(decimals));

/** Degrees of a rotary; beyond two turns what is left of one, and the whole turns. */
function angle(degrees) {
  if (!(Math.abs(degrees) > 720)) return `${fixed(degrees, 2)}\u00b0`;
  const turns = Math.trunc(degrees / 360);
  return `${fixed(degrees - 360 * turns, 2)}\u00b0 (${minus(turns > 0 ? `+${turns}` : `${turns}`)} turns)`;
}

function colourAt(stops, t) {
  let k = 1;
  while (k < stops.length - 1 && t > stops[k][0]) k++;
  const [t0, a] = stops[k - 1], [t1, b] = stops[k], s = Math.max(0, Math.min(1, (t - t0) / (t1 - t0)));
  return a.map((v, i) => Math.round(v + s * (b[i] - v)));
}

/** The next 1, 2 or 5 times a power of ten. */
function niceUp(v) {
  const decade = 10 ** Math.floor(Math.log10(v));
  return [1, 1.5, 2, 3, 4, 5, 6, 8, 10].find((d) => d * decade >= v * (1 - 1e-9)) * decade;
}
