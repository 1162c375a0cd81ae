// Writes what jsPsych's own data module writes (data.get().csv()) of an experiment in simulation mode.
const { JSDOM } = require('jsdom');
const dom = new JSDOM('<!DOCTYPE html><body></body>', { pretendToBeVisual: true, url: 'http://localhost/' });
for (const key of ['window', 'document', 'HTMLElement', 'Element', 'Node', 'KeyboardEvent', 'MouseEvent', 'Event', 'CustomEvent', 'getComputedStyle', 'requestAnimationFrame', 'cancelAnimationFrame', 'DOMParser', 'Image', 'location'])
  global[key] = key === 'window' ? dom.window : dom.window[key];
Object.defineProperty(global, 'navigator', { value: dom.window.navigator, configurable: true });
dom.window.AudioContext = undefined;
const { initJsPsych } = require('jspsych');
const slider = require('@jspsych/plugin-html-slider-response');
const keyboard = require('@jspsych/plugin-html-keyboard-response');
const likert = require('@jspsych/plugin-survey-likert');
const plugin = m => m.default || m;
(async () => {
  const all = [];
  const ratings = { '01': [2.5, 7], '02': [3, 9], '03': [1, 8.25] };
  for (const [who, [ten, hundred]] of Object.entries(ratings)) {
    const jsPsych = initJsPsych({});
    jsPsych.data.addProperties({ who });
    const rate = (rays, response, task, q) => ({
      type: plugin(slider), stimulus: `<img src="img/${rays}.png">`, min: 0, max: 10, slider_start: 5,
      data: { task, rays }, simulation_options: { data: { response, rt: 1200 } } });
    const timeline = [
      { type: plugin(keyboard), stimulus: '<p class="intro">Rate each picture, "0" to 10.</p>', simulation_options: { data: { response: ' ', rt: 900 } } },
      { type: plugin(keyboard), stimulus: '<div>+</div>', choices: 'NO_KEYS', trial_duration: 500, data: { task: 'fixation' } },
      rate('10K', 5, 'practice'), rate('10K', ten, 'rating'), rate('100K', hundred, 'rating'),
      { type: plugin(likert), questions: [{ prompt: 'Tired?', labels: ['no', 'a little', 'very'] }], data: { task: 'again', rays: '10K' }, simulation_options: { data: { response: { Q0: 1 } } } },
    ];
    await jsPsych.simulate(timeline, 'data-only');
    all.push(...jsPsych.data.get().values());
    var last = jsPsych;
  }
  // One file of all, as a server that gathers subjects would have it.
  const joined = last.data.get().filterCustom(() => false);
  joined.trials = all;
  process.stdout.write(joined.csv());
  process.exit(0);
})().catch(e => { console.error(e); process.exit(1); });
