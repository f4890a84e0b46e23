// Each snippet as it is inserted, in a model that has what it names.
"use strict";
const assert = require("node:assert");
const fs = require("node:fs");
const path = require("node:path");
const test = require("node:test");
const { run } = require("../src/program");

const root = path.join(__dirname, "..", "..", "..");
const program = process.env.MAUP || path.join(root, "build", "bin", "maup");
const snippets = JSON.parse(fs.readFileSync(path.join(__dirname, "..", "snippets", "lag.json"), "utf8"));

/// The texts that a body can become, one a choice; places to fill in hold what is proposed.
function texts(body) {
  const choice = /\$\{\d+\|([^|]*)\|\}/.exec(body);
  if (choice) return choice[1].split(",").flatMap((c) => texts(body.replace(choice[0], () => c)));
  return [body.replace(/\$\{\d+:([^}]*)\}/g, "$1").replace(/\$\d+/g, "")];
}

const parameters =
  "param m = 1 kg, l = 1 m, k = 10 N/m, c = 1 kg/s, l0 = 0.5 m, g = 9.81 m/s^2, F = 1 N, Ω = 1 rad/s\n";
const plane = `${parameters}coord x : length, y : length\npoint P mass m at (x, y)\n`;
const falling = `${plane}gravity (0, -g)\nstart x = 0.1 m, y = 1 m\n`;
const turning =
  `${parameters}coord θ : angle\npoint bob mass m at l (sin θ, -cos θ)\ngravity (0, -g)\nstart θ = 1 rad\n`;
const around = {
  "pendulum model": (text) => text,
  param: (text) => `${text}\ncoord x : length\nT = 1/2 m x'^2\n`,
  coord: (text) => {
    const [, name, kind] = /^coord (\S+) : (\S+)$/.exec(text);
    const unit = { angle: "J s^2", length: "kg", number: "J s^2", charge: "H" }[kind];
    return `param I = 1 ${unit}\n${text}\nT = 1/2 I ${name}'^2\n`;
  },
  point: (text) => `param m = 1 kg\ncoord x : length, y : length\n${text}\n`,
  body: (text) => `param m = 1 kg, I1 = 1 kg m^2, I2 = 2 kg m^2, I3 = 2.5 kg m^2\n${text} at (0, 0, 0)\n`,
  constraint: (text) => `${plane}${text}\nstart x = l, y = 0 m\n`,
  contact: (text) => `${falling}${text}\nrun 1 s\n`,
  event: (text) => `${falling}${text}\nrun 1 s\n`,
  "expect value": (text) => `${turning}run 10 s\n${text}\n`,
  "expect energy": (text) => `${turning}run 10 s\n${text}\n`,
  sweep: (text) => `${turning.replace("sin θ", "sin (θ + Ω t)").replace("cos θ", "cos (θ + Ω t)")}run 1 s\n${text}\n`,
};

for (const [name, { body }] of Object.entries(snippets))
  for (const text of texts(body.join("\n")))
    test(`${name}: ${text.split("\n")[0]}`, async () => {
      const model = (around[name] || ((t) => `${plane}${t}\n`))(text);
      const { code, out, err } = await run(program, ["check", "-"], model);
      assert.equal(code, 0, `${model}\n${out}${err}`);
    });
