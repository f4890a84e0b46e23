// The requests and answers of docs/design/studio.md.

export interface Formula {
  mathml: string;
  latex: string;
  plain: string;
}
export interface Line {
  left: Formula | null;
  right: Formula | null;
  mathml: string;
  rule: string;
  sentence: string;
}
export interface Diagnostic {
  code: string;
  severity: 'error' | 'warning' | 'note';
  from: number | null;
  to: number | null;
  line: number | null;
  column: number | null;
  message: string;
  reason: string;
  help: string;
  text: string;
}
export interface Edit {
  from: number;
  to: number;
  insert: string;
}
export interface SceneElement {
  kind: 'path' | 'trail' | 'solid' | 'arrow' | 'label';
  points: number;
  still: boolean;
  positions: number[];
  radii?: number[];
  bobs?: boolean[];
  names?: string[];
  ground?: boolean;
  impulse?: boolean;
  origin?: string; // of an arrow that the model's drawing does not ask for
  [key: string]: unknown;
}
export interface Scene {
  dimension: number;
  times: number[];
  elements: SceneElement[];
  low: number[];
  high: number[];
  radius: number;
  gravity: number[];
  follow: number[];
  dimensionless: boolean;
  metresANewton?: number;
  largestTorque?: number; // N m
  unplacedForces?: string[]; // that no arrow stands for
}
export interface Trouble {
  code: string;
  message: string;
  reason: string;
  help: string;
}
export type TroubleKind = 'request' | 'model' | 'budget' | 'cancelled' | 'refused' | 'internal' | 'connection';
export interface Failure {
  ok: false;
  kind: TroubleKind;
  trouble: Trouble;
  diagnostics?: Diagnostic[];
}
export type Answer<T> = ({ok: true} & T) | Failure;

export interface Request {
  do: string;
  budget?: number;
  [key: string]: unknown;
}
export type Message = {progress?: number; section?: SectionAnswer};

export interface OpenAnswer {
  diagnostics: Diagnostic[];
  tokens: [number, number, string][];
  symbols: Symbol_[];
  folding: [number, number][];
  readable: boolean;
  fields: boolean;
  modes: boolean;
  runs: boolean;
}
export interface Symbol_ {
  name: string;
  detail: string;
  from: number;
  to: number;
  children: Symbol_[];
}
export interface Fix {
  title: string;
  code: string;
  from: number;
  to: number;
  edits: Edit[];
}
export interface CompletionItem {
  label: string;
  kind: string;
  detail: string;
  help: string;
  insert: string;
  snippet: boolean;
  rank: number;
}

export interface Coordinate {
  name: string;
  symbol: Formula;
  velocity: Formula;
  kind: string;
  unit: string;
  velocity_unit: string;
  q: number | null;
  v: number | null;
}
export interface Parameter {
  name: string;
  symbol: Formula;
  value: number | null;
  unit: string;
  si: number | null;
  si_unit: string;
  used: boolean;
  from?: number;
  to?: number;
}
export interface Check {
  name: string;
  statement: string;
  verdict: string;
  passed: boolean;
  applies: boolean;
  points: number;
}
export interface Section {
  title: string;
  lines: Line[];
  notes?: string[];
}
export interface Conserved {
  sentence: string;
  formula: Line;
  value: string;
  drift: string;
}
export interface EquationsAnswer {
  sections?: string[]; // of a driven motion: once in a period of each drive
  title: string;
  name: string;
  source: string;
  summary: [string, string][];
  certified: boolean;
  certificate: Check[];
  diagnostics: Diagnostic[];
  coordinates: Coordinate[];
  parameters: Parameter[];
  definitions: Line[];
  energies: Line[];
  energies_title: string;
  equations: Line[];
  intermediates: Line[];
  in_rates?: {equations: Line[]; definitions: Line[]}; // what is shown first, where the model has them
  derivation?: Section[];
  conserved: Conserved[];
  notes: Note[];
  first_notes?: string[];
  last_notes?: string[];
  contacts: {name: string}[];
  modes?: string[]; // of contacts and dry friction
  holds?: string; // when the equations hold, where there are modes
}
export interface Note {
  line: number;
  text: string;
}
export interface Column {
  name: string;
  unit: string;
}
export interface Happening {
  t: number;
  what: string;
  name: string;
  mode: string;
  impulse?: number | null;
  speed?: number | null;
  remark: string;
}
export interface Table {
  independent: Column;
  columns: Column[];
  times: number[];
  values: (number | null)[][];
}
export interface RunAnswer extends Table {
  drawing: Scene | null;
  statistics: [string, string][];
  happenings: Happening[];
  first_mode: string;
  ending: {ok: boolean; kind: string; reason: string; t: number | null};
  conserved: Conserved[];
  pictures: {caption: string; columns: string[]; phase: boolean; against?: string}[];
  figures: {caption: string; svg: string}[];
  start: Record<string, number | null>;
  uncertain: {from: number; everything: boolean; columns: string[]} | null;
  diagnostics: Diagnostic[];
  places?: number[];
  upwards?: number[];
  fields?: Column[]; // of fields
}
export interface PoseAnswer {
  start: Record<string, number | null>;
  drawing: Scene | null;
  adjusted: string[];
}
export interface ModePoint {
  name: string;
  stability: string;
  stable: boolean;
  formulas: Line[];
  rows: {kind: string; frequency: string; hertz: string; period: string; damping: string}[];
  shapes: {caption: string; drawing: Scene | null; svg: string}[];
}
export interface ModesAnswer {
  points: ModePoint[];
  search: string;
}
export interface PathsAnswer {
  paths: {title: string; facts: [string, string][]}[];
  figures: {caption: string; svg: string}[];
  search: string;
}
export interface SectionAnswer extends Table {
  svg: string;
  across: string;
  crossings: number;
  ended: string;
  energy_conserved: boolean;
}
export interface ClaimAnswer {
  passed: boolean;
  message: string;
  pitfall: string;
  where?: string; // "r > 0": it is right there
}
export interface ExpectationResult {
  line: number;
  text: string;
  claim: boolean;
  passed: boolean;
  actual: string;
  expected: string;
  message: string;
  pitfall: string;
  where: string; // "r > 0": it holds there alone
}
export interface ExportAnswer {
  name: string;
  type: string;
  text?: string;
  base64?: string;
}

/** What stands beside the text in every request that needs the model. */
export interface Values {
  set: Record<string, string>;
  start: Record<string, string>;
  forces?: boolean; // arrows of all forces, not only of those that the model draws
  run?: string;
  mode?: string;
}
