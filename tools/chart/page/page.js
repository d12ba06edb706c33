/**
 * The page of `huestep chart`: puts the charts of charts.js and the tables where they belong.
 *
 * Everything comes from the document that stands in the page; nothing is asked for elsewhere.
 */
(() => {
  'use strict';
  /** @typedef {Record<string, any>} Row */
  const doc = JSON.parse(/** @type {HTMLElement} */ (document.getElementById('document')).textContent ?? '');
  const { short, time, inUnit } = huestepCharts;
  const byId = (/** @type {string} */ id) => /** @type {HTMLElement} */ (document.getElementById(id));

  /**
   * @param {string} tag
   * @param {Record<string, string>} attributes
   * @param {(Node | string)[]} content
   */
  function make(tag, attributes = {}, ...content) {
    const element = document.createElement(tag);
    for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
    element.append(...content);
    return element;
  }

  // ---- light and dark

  const dusk = matchMedia('(prefers-color-scheme: dark)');
  /** @type {string | null} */
  let wanted = null; // what the reader chose, against the system's choice
  const isDark = () => (wanted === null ? dusk.matches : wanted === 'dark');
  function applyTheme() {
    document.documentElement.dataset.theme = isDark() ? 'dark' : 'light';
    byId('theme').textContent = isDark() ? 'light' : 'dark';
  }
  applyTheme();
  byId('theme').addEventListener('click', () => {
    wanted = isDark() ? 'light' : 'dark';
    applyTheme();
    drawAll();
  });
  dusk.addEventListener('change', () => {
    applyTheme();
    drawAll();
  });

  // ---- charts

  const isNarrow = () => innerWidth < 720;
  /** @type {Map<string, {chosen: number, place: HTMLElement, parts: any, chart: any}>} */
  const sections = new Map();

  /** A card's own elements below its heading and text. @param {HTMLElement} card */
  function prepare(card) {
    const parts = {
      choices: make('div', { class: 'choices' }),
      caption: make('p', { class: 'caption' }),
      tools: make('div', { class: 'tools' }),
      plot: make('div', { class: 'plot', role: 'img' }),
      failures: make('details', { class: 'failures' }),
    };
    card.append(parts.choices, parts.caption, parts.tools, parts.plot, parts.failures);
    return { chosen: 0, place: card, parts, chart: null };
  }

  /** A button a choice; of many, a list. @param {string} name @param {any[]} charts */
  function showChoices(name, charts) {
    const section = /** @type {any} */ (sections.get(name));
    const choose = (/** @type {number} */ i) => {
      section.chosen = i;
      drawAll();
    };
    section.parts.choices.hidden = charts.length < 2;
    if (charts.length > 8) {
      const list = /** @type {HTMLSelectElement} */ (
        make('select', { 'aria-label': 'scene' }, ...charts.map((chart, i) => make('option', { value: String(i) }, chart.choice)))
      );
      list.value = String(section.chosen);
      list.addEventListener('change', () => choose(list.selectedIndex));
      section.parts.choices.replaceChildren(make('span', {}, `${charts.length} scenes: `), list);
      return;
    }
    section.parts.choices.replaceChildren(
      ...charts.map((chart, i) => {
        const button = make('button', { type: 'button', 'aria-pressed': String(i === section.chosen) }, chart.choice);
        button.addEventListener('click', () => choose(i));
        return button;
      }),
    );
  }

  /** @param {string} name @param {any} chart */
  function draw(name, chart) {
    const section = /** @type {any} */ (sections.get(name));
    const { parts } = section;
    parts.plot.style.height = `${chart.height}px`;
    parts.plot.setAttribute('aria-label', chart.title);
    parts.caption.textContent = chart.caption;
    if (section.chart) section.chart.dispose();
    section.chart = echarts.init(parts.plot, null, { renderer: 'svg' });
    section.chart.setOption(chart.option);
    let zooming = false;
    const zoom = make('button', { type: 'button', 'aria-pressed': 'false' }, 'zoom');
    zoom.addEventListener('click', () => {
      zooming = !zooming;
      zoom.setAttribute('aria-pressed', String(zooming));
      section.chart.dispatchAction({ type: 'takeGlobalCursor', key: 'dataZoomSelect', dataZoomSelectActive: zooming });
    });
    const whole = make('button', { type: 'button' }, 'whole');
    whole.addEventListener('click', () => {
      for (const i of (chart.option.dataZoom ?? []).keys())
        section.chart.dispatchAction({ type: 'dataZoom', dataZoomIndex: i, start: 0, end: 100 });
    });
    parts.tools.replaceChildren(zoom, whole);
    parts.failures.hidden = chart.failures.length === 0;
    parts.failures.replaceChildren(
      make('summary', {}, name === 'overall' ? `Fail in some of the cases: ${chart.failures.length}` : `Failed, and so without a point: ${chart.failures.length}`),
      make('ul', {}, ...chart.failures.map((/** @type {string} */ text) => make('li', {}, text))),
    );
  }

  function drawAll() {
    const charts = huestepCharts.charts(doc, { dark: isDark(), narrow: isNarrow(), picture: false });
    for (const [name, section] of sections) {
      const own = charts.filter((chart) => chart.section === name);
      section.place.hidden = own.length === 0;
      if (own.length === 0) continue;
      showChoices(name, own);
      draw(name, own[Math.min(section.chosen, own.length - 1)]);
    }
  }

  // ---- tables

  /** @param {string[]} head @param {(Node | string)[][]} rows */
  function table(head, rows) {
    const wide = make(
      'div',
      { class: 'wide' },
      make(
        'table',
        {},
        make('thead', {}, make('tr', {}, ...head.map((text) => make('th', {}, text)))),
        make('tbody', {}, ...rows.map((row) => make('tr', {}, ...row.map((cell) => make('td', {}, cell))))),
      ),
    );
    // A fade says that there is more beyond the edge.
    const frame = make('div', { class: 'frame' }, wide);
    const look = () => frame.classList.toggle('more', wide.scrollLeft + wide.clientWidth < wide.scrollWidth - 2);
    wide.addEventListener('scroll', look, { passive: true });
    new ResizeObserver(look).observe(wide);
    return frame;
  }

  /**
   * What was measured in a cell, in a line of the table below that of the cell: as wide as is seen
   * of the table, however far it is scrolled. The cell pressed again takes it away.
   * @param {HTMLElement} button @param {Row} row @param {string} method @param {Row} cell
   */
  function showVerdicts(button, row, method, cell) {
    const line = /** @type {HTMLTableRowElement} */ (button.closest('tr'));
    const shown = button.getAttribute('aria-expanded') === 'true';
    const body = /** @type {HTMLElement} */ (line.parentElement);
    body.querySelector('.detail')?.remove();
    for (const open of body.querySelectorAll('[aria-expanded="true"]')) open.setAttribute('aria-expanded', 'false');
    if (shown) return;
    button.setAttribute('aria-expanded', 'true');
    const said = cell.verdicts.map((/** @type {Row} */ v) => {
      const value = v.value === null ? 'no number' : short(v.value) + inUnit(v.unit);
      const margin = v.limit > 0 && v.value !== null ? `, ${short(v.limit / v.value)} times within` : '';
      const limit = `limit ${short(v.limit)}${inUnit(v.unit)}${v.pass ? margin : ''}`;
      const frontier = v.frontier === null ? '' : v.frontier > 0 ? `; passes from n = ${v.frontier}` : v.frontier === 0 ? '; passes at no n' : '';
      const judged = v.judged ? '' : ' (reported only)';
      return make('li', {}, `${v.pass ? 'passes' : 'fails'}: ${v.scene}: ${v.what || 'value'} ${value}, ${limit}${frontier}${judged}. ${v.why || ''}`);
    });
    const text = make('div', { 'aria-live': 'polite' }, make('h3', {}, `${row.row} ${row.name}: ${method}`), make('ul', {}, ...said));
    text.style.width = `${/** @type {HTMLElement} */ (line.closest('.wide')).clientWidth}px`;
    line.after(make('tr', { class: 'detail' }, make('td', { colspan: String(line.cells.length) }, text)));
    text.scrollIntoView({ block: 'nearest', inline: 'nearest' });
  }

  function stabilityTable() {
    const rows = huestepCharts.stabilityRows(doc);
    if (rows.length === 0) {
      byId('stability-table').replaceChildren(make('p', { class: 'caption' }, 'The suite was not run for this page.'));
      return;
    }
    byId('frontier-note').hidden = !rows.some((row) => Object.values(row.cells).some((cell) => cell.frontier >= 0));
    const methods = huestepCharts.methodsIn(doc, doc.stability);
    const cellOf = (/** @type {any} */ row, /** @type {string} */ method) => {
      const cell = row.cells[method];
      if (!cell) return '';
      const frontier = cell.frontier > 0 ? `n ≥ ${cell.frontier}` : cell.frontier === 0 ? 'at no n' : '';
      const button = make('button', { type: 'button', class: `verdict ${!cell.judged ? '' : cell.pass ? 'pass' : 'fail'}` }, !cell.judged ? 'not judged' : cell.pass ? 'holds' : 'fails', make('small', {}, frontier));
      button.setAttribute('aria-expanded', 'false');
      button.addEventListener('click', () => showVerdicts(button, row, method, cell));
      return button;
    };
    const totals = methods.map((method) => {
      const own = rows.map((row) => row.cells[method]).filter((cell) => cell?.judged);
      return `${own.filter((cell) => cell.pass).length} of ${own.length}`;
    });
    const whole = table(
      ['row', ...methods],
      [
        ...rows.map((row) => [`${row.row} ${row.name}`, ...methods.map((method) => cellOf(row, method))]),
        ['holds', ...totals],
      ],
    );
    whole.querySelector('table')?.classList.add('verdicts');
    whole.querySelector('tbody tr:last-child')?.classList.add('total');
    for (const [i, head] of whole.querySelectorAll('th').entries())
      if (i > 0 && isProduct(methods[i - 1])) head.classList.add('own');
    byId('stability-table').replaceChildren(whole);
  }

  const isProduct = (/** @type {string} */ name) => doc.methods.some((/** @type {Row} */ m) => m.name === name && m.product);

  function effortTable() {
    if (doc.effort_answers.length === 0) return;
    const rows = doc.effort_answers.map((/** @type {Row} */ a) => {
      const planned = a.planned_cpu_us;
      const ratio = a.least_fixed_cpu_us !== null ? `${short(planned / a.least_fixed_cpu_us)} ×` : '-';
      return [
        a.scene,
        a.least_fixed_substeps === null ? 'none' : String(a.least_fixed_substeps),
        a.least_fixed_cpu_us === null ? '-' : time(a.least_fixed_cpu_us),
        time(a.standard_cpu_us),
        time(planned),
        a.planned_met ? 'met' : 'missed',
        ratio,
        `${short(planned / a.standard_cpu_us)} ×`,
      ];
    });
    byId('effort-table').replaceChildren(
      table(
        ['scene', 'smallest n that is enough', 'its time', `time of n = ${doc.standard_substeps}`, 'planned', 'need', 'planned / smallest n', `planned / n = ${doc.standard_substeps}`],
        rows,
      ),
    );
  }

  /** Every time, once it is asked for. */
  function allRuns() {
    const place = byId('all-runs');
    place.addEventListener('toggle', () => {
      if (place.childElementCount > 1) return;
      const rows = ['work_precision', 'sizes', 'scenes', 'prices', 'effort'].flatMap((name) =>
        doc[name].map((/** @type {Row} */ r) => [
          r.scene,
          huestepCharts.who(r),
          String(r.threads) + (r.share_all ? ', always' : ''),
          String(r.ticks),
          time(r.cpu_us_min),
          `${time(r.cpu_us_q1)} … ${time(r.cpu_us_q3)}`,
          time(r.wall_us_min),
          make('span', { class: 'mono' }, r.hash + (r.different_hashes > 1 ? ` +${r.different_hashes - 1}` : '')),
        ]),
      );
      place.append(table(['scene', 'method', 'threads', 'steps', 'CPU, least', 'quartiles', 'clock, least', 'hash'], rows));
    });
  }

  // ---- words

  /** What the figures say, in sentences. */
  function answers() {
    /** @type {string[]} */
    const said = [];
    const own = doc.methods.find((/** @type {Row} */ m) => m.product).name;
    const wins = doc.cases.filter((/** @type {Row} */ c) =>
      doc.work_precision.some((/** @type {Row} */ p) => p.case === c.id && p.front && p.method === own),
    ).length;
    if (doc.cases.length > 0)
      said.push(`In ${wins} of ${doc.cases.length} cases some n of ${own} is among the points that nothing beats in both speed and accuracy.`);
    const rows = huestepCharts.stabilityRows(doc);
    if (rows.length > 0) {
      const count = (/** @type {string} */ method) => rows.filter((row) => row.cells[method]?.judged && row.cells[method].pass).length;
      const others = huestepCharts.methodsIn(doc, doc.stability).filter((name) => name !== own);
      const best = others.sort((a, b) => count(b) - count(a))[0];
      said.push(
        `Of ${rows.length} rows of scenes that solvers fall over, ${own} holds ${count(own)}` +
          (best ? `; the best of the others, ${best}, ${count(best)}.` : '.'),
      );
    }
    // Of a machine that did other things as well the clock tells nothing about a second thread.
    for (const c of doc.crossings.filter((/** @type {Row} */ r) => r.question === 'a second thread pays' && !huestepCharts.busy(doc))) {
      const what = c.family === 'net' ? 'a net of joints' : `one ${c.family}`;
      said.push(
        c.from_constraints === null
          ? `A second thread does not pay in ${what} of up to ${c.most_measured} constraints.`
          : `A second thread pays in ${what} from ${c.at_most ? 'at most' : 'about'} ${c.from_constraints} constraints on${c.at_most ? ', the fewest that were measured' : ''}.`,
      );
    }
    const most = Math.max(0, ...doc.scenes.map((/** @type {Row} */ r) => r.overflow_share));
    if (doc.scenes.length > 0)
      said.push(most === 0 ? 'In none of the scenes here is a constraint left to one thread because it finds no colour.' : `At most ${short(100 * most)} % of the constraints of a scene here are left to one thread because they find no colour.`);
    const unsteady = [...new Set(doc.prices.filter((/** @type {Row} */ r) => huestepCharts.unsteady(doc, r)).map((/** @type {Row} */ r) => r.method))];
    const mayBe = (/** @type {string} */ name) => doc.methods.some((/** @type {Row} */ m) => m.name === name && !m.deterministic);
    const known = unsteady.filter(mayBe);
    if (known.length > 0)
      said.push(`Different from run to run, or on two threads from one, and therefore no choice for lockstep: ${known.join(', ')}.`);
    const wrong = unsteady.filter((name) => !mayBe(name));
    if (wrong.length > 0)
      said.push(`Different from run to run, or on two threads from one, which must not be and is a fault of this build: ${wrong.join(', ')}.`);
    const planned = doc.effort_answers.filter((/** @type {Row} */ a) => a.least_fixed_substeps !== null);
    if (planned.length > 0) {
      const met = planned.filter((/** @type {Row} */ a) => a.planned_met);
      const cheaper = met.filter((/** @type {Row} */ a) => a.planned_cpu_us < a.least_fixed_cpu_us);
      said.push(`Where some fixed n meets the need, planned effort meets it in ${met.length} of ${planned.length} scenes, and in ${cheaper.length} in less time than the smallest such n of that scene.`);
      // One number for all of them has to be that of the hardest.
      const all = Math.max(...planned.map((/** @type {Row} */ a) => a.least_fixed_substeps));
      const share = planned.flatMap((/** @type {Row} */ a) => {
        const fixed = doc.effort.find((/** @type {Row} */ r) => r.scene === a.scene && r.substeps === all);
        return fixed ? [Math.log(a.planned_cpu_us / fixed.cpu_us_min)] : [];
      });
      const mean = Math.exp(share.reduce((/** @type {number} */ sum, /** @type {number} */ x) => sum + x, 0) / share.length);
      said.push(`One fixed n for all of them would have to be ${all}; planned effort takes ${short(mean)} times its time (geometric mean over the ${share.length} scenes that were run with it).`);
    }
    byId('answers').replaceChildren(...said.map((text) => make('li', {}, text)));
  }

  /** @param {[string, string][]} pairs */
  const list = (pairs) => make('dl', {}, ...pairs.flatMap(([name, text]) => [make('dt', {}, name), make('dd', {}, text)]));

  function terms() {
    const quick = doc.extent === 'full' ? '' : ` --${doc.extent}`;
    byId('origin').textContent = `${doc.date} · ${doc.machine} · ${doc.compiler} · commit ${doc.commit}` +
      (doc.extent === 'full' ? '' : ` · ${doc.extent} run: fewer and smaller scenes`);
    byId('busy').hidden = !huestepCharts.busy(doc);
    byId('terms').replaceChildren(
      make('p', {}, `Fixed work, no sleeping. Everything that is compared with each other ran in turn, A B C, A B C, ${doc.repeats} times, so that each met the same weather; the least of these times is shown, quartiles with the point. CPU time is what the processor spent on the work, whatever else the machine did; the clock is used where two threads are there to finish earlier. A hash of all motions was taken after every run.`),
      list([
        ['machine', doc.machine],
        ['compiler', doc.compiler],
        ['commit', doc.commit],
        ['date', doc.date],
        ['took', `${Math.round(doc.seconds)} s`],
        ['to repeat', `huestep chart --out DIR${quick}`],
        ['figures', 'results.json and a CSV file a table, beside this page'],
      ]),
      make('h3', {}, 'Methods'),
      list(doc.methods.map((/** @type {Row} */ m) => [m.name, m.summary + (m.deterministic ? '' : ' (results differ from run to run)')])),
    );
  }

  // ---- all of it

  for (const [name, title] of Object.entries(huestepCharts.groups)) {
    const card = make('article', { class: 'card', 'data-section': `work-${name}` }, make('h3', {}, title));
    byId('groups').append(card);
  }
  for (const card of document.querySelectorAll('[data-section]')) {
    const element = /** @type {HTMLElement} */ (card);
    sections.set(element.dataset.section ?? '', prepare(element));
  }
  terms();
  answers();
  stabilityTable();
  effortTable();
  allRuns();
  drawAll();

  // For tests: where a point of a chart is, and what an axis shows, as shares of it all.
  Object.assign(window, {
    huestepPage: {
      /** Pixels of a series' first point in its plot. @param {string} section @param {string} name */
      placeOf(section, name) {
        const { chart } = /** @type {any} */ (sections.get(section));
        const series = chart.getOption().series.find((/** @type {Row} */ each) => each.name === name);
        return chart.convertToPixel({ gridIndex: 0 }, series.data[0].value);
      },
      /** @param {string} section */
      rangeOf(section) {
        const [zoom] = /** @type {any} */ (sections.get(section)).chart.getOption().dataZoom;
        return [zoom.start, zoom.end];
      },
    },
  });

  let narrow = isNarrow();
  addEventListener('resize', () => {
    if (narrow !== isNarrow()) {
      narrow = isNarrow();
      drawAll();
    } else {
      for (const { chart } of sections.values()) chart?.resize();
    }
  });
})();
