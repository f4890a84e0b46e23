// node compare_test.mjs: that the comparison of two answers sees what it is there to see, and no more.
import {compare} from './requests.mjs';

const answer = (actual, tolerance) => ({
  ok: true,
  results: [{text: 'expect u(1) at 4 = 0', actual, expected: '0', tolerance, passed: true}],
});
const differ = (a, b, tolerance) =>
  compare('a model', {do: 'expectations'}, answer(a, tolerance), answer(b, tolerance)).length > 0;
const cases = [
  [false, '1.2263e-09', '1.2264e-09', '± 1e-06'], // of a value that is 0 within 1e-6 the fifth digit is rounding
  [true, '1.2263e-09', '2.3e-08', '± 1e-06'], // not so the fifth digit of the tolerance
  [true, '1.2263e-09', '1.2264e-09', 'rel 1e-09'],
  [true, '12.8000 m', '12.8002 m', '± 1e-06 m'],
  [false, '12.80001 m', '12.80002 m', '± 1e-06 m'],
  [true, '12.8 m', '12.8 s', '± 1e-06 m'],
  [false, '0', '3e-15', ''],
  [true, '0', '3e-13', ''],
];
const wrong = cases.filter(([differs, ...given]) => differ(...given) !== differs);
for (const one of wrong) console.log(`wrongly judged: ${JSON.stringify(one)}`);
process.exitCode = wrong.length ? 1 : 0;
