/**
 * What the charts show: from the document of `huestep chart` to descriptions that ECharts draws.
 *
 * The page draws them in the browser; the pictures are drawn from the same descriptions by Duktape,
 * which knows the language as of 2009: so this file keeps to that.
 *
 * @typedef {Record<string, any>} Row a flat row of a table of the document
 * @typedef {Record<string, any>} Option what ECharts takes
 * @typedef {{dark: boolean, narrow: boolean, picture: boolean}} Look
 * @typedef {{name: string, section: string, choice: string, title: string, caption: string,
 *   failures: string[], height: number, option: Option}} Chart
 */
var huestepCharts = (function () {
  'use strict';

  var groups = {
    joint: 'Joints',
    stack: 'Stacks',
    friction: 'Friction',
    impact: 'Impacts',
    mixed: 'Everything together',
  };
  var hues = {
    light: ['#0a5fd6', '#c2410c', '#0f766e', '#a16207', '#7e22ce', '#be185d', '#4d7c0f', '#0e7490',
      '#854d0e', '#b91c1c', '#475569', '#4338ca'],
    dark: ['#6cb2ff', '#fb923c', '#2dd4bf', '#facc15', '#c084fc', '#f472b6', '#a3e635', '#22d3ee',
      '#d6a96a', '#f87171', '#cbd5e1', '#a5b4fc'],
  };
  var symbols = ['circle', 'rect', 'triangle', 'diamond', 'roundRect'];

  /** @param {Look} look */
  function inks(look) {
    return look.dark
      ? { text: '#e6e8ec', faint: '#9aa3b2', grid: '#2c3340', paper: '#151922', good: '#2dd4bf', bad: '#f87171' }
      : { text: '#1b2330', faint: '#5d6878', grid: '#e3e7ee', paper: '#ffffff', good: '#0f766e', bad: '#b91c1c' };
  }

  // ---- numbers and words

  /** @param {number} value */
  function short(value) {
    if (value === null || value === undefined) return '-';
    if (value === 0) return '0';
    var size = Math.abs(value);
    if (size >= 1e5 || size < 1e-3) {
      var parts = value.toExponential(1).split('e');
      return parts[0].replace('.0', '') + '·10' + raised(Number(parts[1]));
    }
    return String(Number(value.toPrecision(3)));
  }

  /** @param {number} exponent */
  function raised(exponent) {
    return String(exponent).replace(/[-0-9]/g, function (c) {
      return c === '-' ? '⁻' : '⁰¹²³⁴⁵⁶⁷⁸⁹'.charAt(Number(c));
    });
  }

  /** A label of a logarithmic axis. @param {number} value */
  function decade(value) {
    var exponent = Math.round(Math.log(value) / Math.LN10);
    // The ends of an axis are no powers of ten.
    if (Math.abs(value / Math.pow(10, exponent) - 1) > 1e-6) return '';
    if (exponent >= -2 && exponent <= 4) return String(Number(value.toPrecision(1)));
    return '10' + raised(exponent);
  }

  /** @param {string} unit */
  function inUnit(unit) {
    return unit === '1' || unit === '' ? '' : ' ' + unit;
  }

  /** @param {number} us microseconds */
  function time(us) {
    if (us >= 1000) return short(us / 1000) + ' ms';
    return short(us) + ' µs';
  }

  /** @param {unknown} text */
  function escaped(text) {
    return String(text).replace(/&/g, '&amp;').replace(/</g, '&lt;').replace(/"/g, '&quot;');
  }

  /** @param {Row} row */
  function who(row) {
    if (row.substeps === 0) return row.method === 'soft-step' ? 'soft-step, planned' : row.method;
    return row.method + ', n = ' + row.substeps;
  }

  /** What stands in the box of a point. @param {Row} row @param {string[]} lines */
  function box(row, lines) {
    var threads = row.threads + (row.threads === 1 ? ' thread' : ' threads');
    var all = ['<b>' + escaped(who(row)) + '</b>'].concat(
      lines,
      'CPU ' + time(row.cpu_us_min) + ' a step (quartiles ' + time(row.cpu_us_q1) + ', ' + time(row.cpu_us_q3) + ')',
      'by the clock ' + time(row.wall_us_min) + ', ' + threads,
      row.ticks + ' steps × ' + row.repeats + ' of ' + escaped(row.scene),
      'hash ' + row.hash + (row.different_hashes > 1 ? ', and ' + (row.different_hashes - 1) + ' others: not repeatable' : ''));
    return all.join('<br>');
  }

  /**
   * Whether other programs ran beside the measurements: then work on one thread, which has nothing
   * to wait for, took longer by the clock than the processor spent on it. @param {Row} doc
   */
  function busy(doc) {
    var shares = doc.sizes.concat(doc.scenes)
      .filter(function (/** @type {Row} */ row) { return row.threads === 1 && row.cpu_us_median > 0; })
      .map(function (/** @type {Row} */ row) { return row.wall_us_median / row.cpu_us_median; })
      .sort(function (/** @type {number} */ a, /** @type {number} */ b) { return a - b; });
    return shares.length > 0 && shares[Math.floor(shares.length / 2)] > 1.2;
  }

  // ---- what all charts have

  /** @param {Row} doc @param {string} method @param {Look} look */
  function styleOf(doc, method, look) {
    var place = 0;
    while (place < doc.methods.length && doc.methods[place].name !== method) ++place;
    var product = place < doc.methods.length && doc.methods[place].product;
    var colours = look.dark ? hues.dark : hues.light;
    return {
      color: colours[place % colours.length],
      symbol: symbols[place % symbols.length],
      width: product ? 3.5 : 1.4,
      size: product ? 10 : 7,
      product: product,
      label: product ? method + ' (Huestep)' : method,
    };
  }

  /** @param {Look} look @param {string} name @param {Option} more */
  function axis(look, name, more) {
    var ink = inks(look);
    /** @type {Option} */
    var all = {
      name: name,
      nameLocation: 'middle',
      nameTextStyle: { color: ink.text, fontSize: look.narrow ? 11 : 13 },
      axisLabel: { color: ink.faint, fontSize: look.narrow ? 10 : 12, hideOverlap: true },
      axisLine: { show: true, lineStyle: { color: ink.faint } },
      axisTick: { show: false },
      splitLine: { show: true, lineStyle: { color: ink.grid } },
    };
    for (var key in more) all[key] = more[key];
    return all;
  }

  /** The range of a logarithmic axis around values. @param {number[]} values */
  function decades(values) {
    var low = Infinity;
    var high = 0;
    values.forEach(function (v) {
      if (v > 0 && isFinite(v)) {
        low = Math.min(low, v);
        high = Math.max(high, v);
      }
    });
    if (high === 0) return { min: 0.1, max: 10 };
    var from = Math.log(low) / Math.LN10 - 0.12;
    var to = Math.log(high) / Math.LN10 + 0.16;
    // An axis with a single power of ten on it could not be read.
    if (Math.floor(to) - Math.ceil(from) < 1) {
      if (from - Math.floor(from) < Math.ceil(to) - to) from = Math.floor(from);
      else to = Math.ceil(to);
    }
    if (Math.floor(to) - Math.ceil(from) < 1) {
      from = Math.floor(from);
      to = Math.ceil(to);
    }
    return { min: Math.pow(10, from), max: Math.pow(10, to) };
  }

  /**
   * An axis of ratios: of powers of two, or of ten where these are so many that they say nothing;
   * the 1 is on it. @param {Look} look @param {number[]} values @returns {Option}
   */
  function ratios(look, values) {
    var good = values.filter(function (v) { return v > 0 && isFinite(v); }).concat(1);
    var low = Math.min.apply(null, good);
    var high = Math.max.apply(null, good);
    var wide = high / low > 64;
    var span = wide
      ? decades(good)
      : { min: Math.pow(2, Math.floor(Math.log(low / 1.06) / Math.LN2)), max: Math.pow(2, Math.ceil(Math.log(high * 1.06) / Math.LN2)) };
    return { type: 'log', logBase: wide ? 10 : 2, min: span.min, max: span.max, axisLabel: { color: inks(look).faint, formatter: wide ? decade : short } };
  }

  /** A label that can be read before lines and marks. @param {Look} look @param {Option} more @returns {Option} */
  function legible(look, more) {
    /** @type {Option} */
    var all = { distance: 8, textBorderColor: inks(look).paper, textBorderWidth: 3 };
    for (var key in more) all[key] = more[key];
    return all;
  }

  /** A third of the smallest error that is not zero, if one is. @param {number[]} errors */
  function leastOf(errors) {
    var positive = errors.filter(function (e) { return e > 0; });
    if (positive.length === 0) return 1;
    var low = Math.min.apply(null, positive);
    return positive.length < errors.length ? low / 3 : low;
  }

  /** @param {string} text */
  function sentence(text) {
    return text.charAt(0).toUpperCase() + text.slice(1) + (/[.!?]$/.test(text) ? '' : '.');
  }

  /** @param {Look} look @param {string} text where the good points are */
  function better(look, text) {
    return {
      type: 'text',
      left: look.narrow ? 58 : 92,
      bottom: look.narrow ? 162 : 66,
      silent: true,
      z: 0,
      style: { text: text, fill: inks(look).good, font: 'bold ' + (look.narrow ? 11 : 13) + 'px system-ui, sans-serif' },
    };
  }

  /** @param {Look} look @param {string} title @param {string[]} failures @param {Option} more */
  function option(look, title, failures, more) {
    var ink = inks(look);
    var below = failures.length === 0 ? '' : 'Failed: ' + failures.join('; ');
    /** @type {Option} */
    var all = {
      animation: false,
      backgroundColor: look.picture ? ink.paper : 'transparent',
      textStyle: { fontFamily: 'system-ui, sans-serif', color: ink.text },
      title: look.picture
        ? { text: title, subtext: wrapped(below, 130), left: 14, top: 8, textStyle: { color: ink.text, fontSize: 17 },
            subtextStyle: { color: ink.bad, fontSize: 11, lineHeight: 14 } }
        : { show: false },
      grid: look.narrow
        ? { left: 50, right: 14, top: 16, bottom: 152 }
        : { left: 78, right: 226, top: look.picture ? 56 + 14 * lineCount(below, 130) : 18, bottom: 56 },
      legend: look.narrow
        ? { itemWidth: 16, itemHeight: 10, itemGap: 5, bottom: 0, left: 0, right: 0, textStyle: { color: ink.text, fontSize: 11 } }
        // Outside a browser widths of texts are guessed, too short.
        : { orient: 'vertical', right: look.picture ? 32 : 6, top: look.picture ? 56 : 14, textStyle: { color: ink.text, fontSize: 12 }, itemGap: 7 },
      tooltip: {
        trigger: 'item',
        confine: true,
        backgroundColor: ink.paper,
        borderColor: ink.grid,
        textStyle: { color: ink.text, fontSize: look.narrow ? 11 : 13 },
        /** @param {any} point */
        formatter: function (point) { return point.data && point.data.box ? point.data.box : ''; },
      },
    };
    for (var key in more) all[key] = more[key];
    return all;
  }

  /** @param {Look} look @param {string} axes which of them a box zooms @returns {Option} */
  function zoom(look, axes) {
    if (look.picture) return {};
    var x = axes.indexOf('x') >= 0 ? 0 : false;
    var y = axes.indexOf('y') >= 0 ? 0 : false;
    /** @type {Option[]} */
    var inside = [];
    if (x !== false) inside.push({ type: 'inside', xAxisIndex: 0, filterMode: 'none', zoomOnMouseWheel: 'ctrl', moveOnMouseMove: 'ctrl', preventDefaultMouseMove: false });
    if (y !== false) inside.push({ type: 'inside', yAxisIndex: 0, filterMode: 'none', zoomOnMouseWheel: 'ctrl', moveOnMouseMove: 'ctrl', preventDefaultMouseMove: false });
    return {
      dataZoom: inside,
      toolbox: { show: true, right: -999, feature: { dataZoom: { xAxisIndex: x, yAxisIndex: y, filterMode: 'none', brushStyle: { color: 'rgba(100,150,255,0.2)' } } } },
    };
  }

  /** @param {string} text @param {number} width letters */
  function lines(text, width) {
    /** @type {string[]} */
    var all = [];
    text.split(' ').forEach(function (word) {
      if (word === '') return;
      if (all.length === 0 || (all[all.length - 1] + ' ' + word).length > width) all.push(word);
      else all[all.length - 1] += ' ' + word;
    });
    return all.slice(0, 8);
  }
  /** @param {string} text @param {number} width */
  function wrapped(text, width) { return lines(text, width).join('\n'); }
  /** @param {string} text @param {number} width */
  function lineCount(text, width) { return lines(text, width).length; }

  /** Names in the order of the document's methods. @param {Row} doc @param {Row[]} rows @returns {string[]} */
  function methodsIn(doc, rows) {
    return doc.methods
      .map(function (/** @type {Row} */ method) { return method.name; })
      .filter(function (/** @type {string} */ name) {
        return rows.some(function (row) { return row.method === name; });
      });
  }

  /** "jacobi n = 1, 2 (bodies fly apart)" @param {Row} doc @param {Row[]} failed */
  function failureList(doc, failed) {
    return methodsIn(doc, failed).map(function (/** @type {string} */ name) {
      var these = failed.filter(function (row) { return row.method === name; });
      var n = these.map(function (row) { return row.substeps; }).filter(Boolean);
      /** @type {string[]} */
      var whys = [];
      these.forEach(function (row) { if (whys.indexOf(row.failure) < 0) whys.push(row.failure); });
      return name + (n.length > 0 ? ' n = ' + n.join(', ') : '') + ' (' + whys.join('; ') + ')';
    });
  }

  // ---- speed against accuracy

  var plannedName = 'soft-step, planned (Huestep)';

  /** Curves of points with `x`, `y` and `row`. @param {Row} doc @param {Look} look @param {Row[]} points */
  function curves(doc, look, points) {
    var ink = inks(look);
    /** @type {Option[]} */
    var all = [];
    methodsIn(doc, points.map(function (p) { return p.row; })).forEach(function (/** @type {string} */ name) {
      var style = styleOf(doc, name, look);
      var these = points.filter(function (p) { return p.row.method === name; });
      these.sort(function (a, b) { return a.row.substeps - b.row.substeps; });
      var planned = these.filter(function (p) { return style.product && p.row.substeps === 0; });
      var fixed = these.filter(function (p) { return !style.product || p.row.substeps > 0; });
      if (planned.length > 0) all.push(curve(planned, style, plannedName, 'diamond'));
      all.push(curve(fixed, style, style.product ? name + ', fixed n' : style.label, style.symbol));
    });
    return all;

    /** @param {Row[]} these @param {Row} style @param {string} label @param {string} symbol */
    function curve(these, style, label, symbol) {
      return {
        type: 'line',
        name: label,
        z: style.product ? 5 : 3,
        symbol: symbol,
        showAllSymbol: true,
        itemStyle: { color: style.color },
        lineStyle: { color: style.color, width: style.width, opacity: style.product ? 1 : 0.75 },
        emphasis: { focus: 'series' },
        data: these.map(function (p) {
          var ring = p.row.standard;
          return {
            value: [p.x, p.y],
            box: p.box,
            symbolSize: style.size + (ring ? (style.product ? 10 : 6) : 0),
            itemStyle: { color: style.color, borderColor: ring ? ink.text : style.color, borderWidth: ring ? 2 : 0 },
            label: legible(look, {
              show: style.product, position: p.row.substeps === 0 ? 'bottom' : 'top', fontSize: look.narrow ? 9 : 11, color: style.color,
              formatter: p.row.substeps === 0 ? 'planned' : 'n = ' + p.row.substeps,
            }),
          };
        }),
      };
    }
  }

  /** The line through the points that no other beats. @param {Look} look @param {Row[]} points @param {Row[]} floors */
  function frontLine(look, points, floors) {
    var ink = inks(look);
    var best = points.filter(function (p) { return p.row.front; });
    best.sort(function (a, b) { return a.x - b.x; });
    return {
      type: 'line', name: 'best of all', silent: true, z: 1, symbol: 'none',
      lineStyle: { color: ink.faint, width: 9, opacity: 0.28 }, itemStyle: { color: ink.faint },
      data: best.map(function (p) { return [p.x, p.y]; }),
      markLine: {
        silent: true, symbol: 'none', precision: -1, lineStyle: { color: ink.bad, type: 'dotted', width: 1.5 },
        label: legible(look, { distance: 4, color: ink.bad, fontSize: 11, position: 'insideEndTop' }),
        data: floors.map(function (floor) { return { xAxis: floor.error, label: { formatter: floor.label } }; }),
      },
    };
  }

  /** @param {Row} doc @param {Look} look @returns {Chart[]} */
  function work(doc, look) {
    return doc.cases.map(function (/** @type {Row} */ one) {
      var all = doc.work_precision.filter(function (/** @type {Row} */ row) { return row['case'] === one.id; });
      var good = all.filter(function (/** @type {Row} */ row) { return row.error !== null; });
      var failed = all.filter(function (/** @type {Row} */ row) { return row.error === null; });
      var errors = good.map(function (/** @type {Row} */ row) { return row.error; });
      var least = leastOf(errors);  // where an error of zero stands: an axis of powers has none
      var points = good.map(function (/** @type {Row} */ row) {
        return {
          row: row, x: Math.max(row.error, least), y: row.cpu_us_min,
          box: box(row, ['error ' + short(row.error) + inUnit(one.unit)]),
        };
      });
      var floors = one.floors.filter(function (/** @type {Row} */ floor) { return floor.error >= 0.03 * least; });
      var series = curves(doc, look, points);
      series.push(frontLine(look, points, floors));
      var failures = failureList(doc, failed);
      var spanX = decades(errors.concat(least, floors.map(function (/** @type {Row} */ floor) { return floor.error; })));
      var spanY = decades(points.map(function (/** @type {Row} */ p) { return p.y; }));
      var unit = one.unit === '1' ? 'as a share' : one.unit;
      var more = zoom(look, 'xy');
      more.xAxis = axis(look, 'error, ' + unit + '  →  worse', { type: 'log', nameGap: 28, min: spanX.min, max: spanX.max, axisLabel: { color: inks(look).faint, formatter: decade, hideOverlap: true } });
      more.yAxis = axis(look, 'CPU time a step, µs  →  slower', { type: 'log', nameGap: look.narrow ? 34 : 48, min: spanY.min, max: spanY.max, axisLabel: { color: inks(look).faint, formatter: decade } });
      more.graphic = [better(look, '↙ better')];
      more.series = series;
      return {
        name: 'work-' + one['class'] + '-' + one.id,
        section: 'work-' + one['class'],
        choice: one.title,
        title: (groups[/** @type {keyof typeof groups} */ (one['class'])] || one['class']) + ': ' + one.title,
        caption: sentence(one.what) + ' Held against: ' + one.reference + '. (' + one.metric + ', ' + one.ticks + ' steps of ' + one.scene + '.)',
        failures: failures,
        height: look.narrow ? 470 : 460,
        option: option(look, one.title + ': error against time', failures, more),
      };
    });
  }

  /** @param {Row} doc @param {Look} look @returns {Chart[]} */
  function overall(doc, look) {
    var ink = inks(look);
    var good = doc.overall.filter(function (/** @type {Row} */ row) { return row.error_ratio_median !== null && row.time_ratio_median !== null; });
    if (good.length === 0) return [];
    var failures = doc.overall
      .filter(function (/** @type {Row} */ row) { return row.failures > 0; })
      .map(function (/** @type {Row} */ row) { return who(row) + ' in ' + row.failures + ' of ' + row.cases; });
    var points = good.map(function (/** @type {Row} */ row) {
      return {
        row: row, x: row.error_ratio_median, y: row.time_ratio_median,
        box: ['<b>' + escaped(who(row)) + '</b>', short(row.error_ratio_median) + ' × the error',
          short(row.time_ratio_median) + ' × the CPU time', 'of soft-step as planned, in the median of ' + row.cases + ' cases',
          row.failures > 0 ? 'fails in ' + row.failures + ' of them' : 'fails in none of them'].join('<br>'),
      };
    });
    var series = curves(doc, look, points);
    var front = frontLine(look, points, []);
    /** @type {any} */ (front.markLine).data = [{ xAxis: 1 }, { yAxis: 1 }];
    /** @type {any} */ (front.markLine).label = { show: false };
    /** @type {any} */ (front.markLine).lineStyle = { color: ink.faint, type: 'dashed', width: 1 };
    series.push(front);
    var spanX = decades(points.map(function (/** @type {Row} */ p) { return p.x; }));
    var spanY = decades(points.map(function (/** @type {Row} */ p) { return p.y; }));
    var more = zoom(look, 'xy');
    more.xAxis = axis(look, 'error, times Huestep’s as it comes  →  worse', { type: 'log', nameGap: 28, min: spanX.min, max: spanX.max, axisLabel: { color: ink.faint, formatter: decade, hideOverlap: true } });
    more.yAxis = axis(look, 'CPU time, times Huestep’s as it comes  →  slower', { type: 'log', nameGap: look.narrow ? 34 : 48, min: spanY.min, max: spanY.max, axisLabel: { color: ink.faint, formatter: decade } });
    more.graphic = [better(look, '↙ better')];
    more.series = series;
    return [{
      name: 'overall', section: 'overall', choice: 'All cases', title: 'All cases together',
      caption: '', failures: failures, height: look.narrow ? 490 : 520,
      option: option(look, 'Error against time over all cases, relative to Huestep as it comes', failures, more),
    }];
  }

  // ---- colours and threads

  var reference = 'colours, 1 thread';

  /** @param {Row} doc @param {Look} look @returns {Chart[]} */
  function sizes(doc, look) {
    var ink = inks(look);
    var colours = look.dark ? hues.dark : hues.light;
    /** @type {string[]} */
    var families = [];
    doc.sizes.forEach(function (/** @type {Row} */ row) { if (families.indexOf(row.family) < 0) families.push(row.family); });
    return families.map(function (family) {
      var rows = doc.sizes.filter(function (/** @type {Row} */ row) { return row.family === family; });
      /** @type {Record<string, number>} */
      var least = {};
      /** @type {string[]} */
      var ways = [];
      rows.forEach(function (/** @type {Row} */ row) {
        if (row.way === reference) least[row.scene] = row.wall_us_min;
        else if (ways.indexOf(row.way) < 0) ways.push(row.way);
      });
      var crossing = doc.crossings.filter(function (/** @type {Row} */ row) { return row.family === family && row.question === 'a second thread pays'; })[0];
      var series = ways.map(function (way, place) {
        var product = way.indexOf('worth') >= 0;
        var color = colours[product ? 0 : place === 0 ? 10 : 1];
        return {
          type: 'line', name: way, symbol: symbols[place], symbolSize: product ? 9 : 7, z: product ? 5 : 3,
          itemStyle: { color: color }, lineStyle: { color: color, width: product ? 3.5 : 1.6 }, emphasis: { focus: 'series' },
          data: rows.filter(function (/** @type {Row} */ row) { return row.way === way; }).map(function (/** @type {Row} */ row) {
            var ratio = row.wall_us_min / least[row.scene];
            return { value: [row.constraints, ratio], box: box(row, [escaped(way), row.constraints + ' constraints, ' + row.colours + ' colours', short(ratio) + ' × the time of colours on 1 thread']) };
          }),
        };
      });
      /** @type {any[]} */
      var marks = [{ yAxis: 1, label: { formatter: look.narrow ? '' : 'colours, 1 thread', position: 'insideStartTop' } }];
      if (crossing && crossing.from_constraints && !busy(doc))
        marks.push({ xAxis: crossing.from_constraints, lineStyle: { color: colours[1], type: 'dotted' }, label: { color: colours[1], formatter: 'pays from ' + (crossing.at_most ? 'at most ' : '') + crossing.from_constraints, position: 'insideEndTop' } });
      /** @type {any} */ (series[0]).markLine = { silent: true, symbol: 'none', label: legible(look, { distance: 6, color: ink.text, fontSize: 11 }), lineStyle: { color: ink.text, type: 'solid', width: 1 }, data: marks };
      var spanX = decades(rows.map(function (/** @type {Row} */ row) { return row.constraints; }));
      var more = zoom(look, 'xy');
      more.xAxis = axis(look, 'constraints in the one island', { type: 'log', nameGap: 28, min: spanX.min, max: spanX.max, axisLabel: { color: ink.faint, formatter: decade } });
      var spanY = ratios(look, rows.map(function (/** @type {Row} */ row) { return row.wall_us_min / least[row.scene]; }));
      spanY.nameGap = look.narrow ? 34 : 48;
      more.yAxis = axis(look, 'time, × colours on 1 thread  →  slower', spanY);
      more.series = series;
      more.legend = legendBelow(look);
      more.grid = look.narrow
        ? { left: 50, right: 14, top: 16, bottom: 112 }
        : { left: 78, right: 30, top: look.picture ? 56 : 18, bottom: 84 };
      return {
        name: 'sizes-' + family, section: 'sizes', choice: family === 'net' ? 'Nets of joints' : family === 'pyramid' ? 'Pyramids of boxes' : family,
        title: 'From which size on threads pay', caption: '', failures: [], height: look.narrow ? 410 : 420,
        option: option(look, 'From which size on colours and threads pay: ' + family, [], more),
      };
    });
  }

  /** @param {Look} look */
  function legendBelow(look) {
    var ink = inks(look);
    return {
      bottom: 2, left: 'center', itemWidth: 14, itemHeight: 12, itemGap: look.narrow ? 6 : 12,
      textStyle: { color: ink.text, fontSize: look.narrow ? 11 : 12 },
    };
  }

  /** Scenes down, a value across. @param {Look} look @param {string[]} names @param {string} what @param {Option} value @param {Option[]} series */
  function across(look, names, what, value, series) {
    var ink = inks(look);
    var more = zoom(look, 'x');
    more.grid = look.narrow
      ? { left: 118, right: 16, top: 14, bottom: 112 }
      : { left: 236, right: look.picture ? 30 : 24, top: look.picture ? 46 : 14, bottom: 84 };
    more.legend = legendBelow(look);
    more.xAxis = axis(look, what, value);
    more.yAxis = axis(look, '', {
      type: 'category', inverse: true, data: names, splitLine: { show: true, lineStyle: { color: ink.grid } },
      axisLabel: { color: ink.text, fontSize: look.narrow ? 9 : 12, width: look.narrow ? 108 : 222, lineHeight: 12, overflow: 'break', interval: 0 },
    });
    more.series = series;
    return more;
  }

  /** @param {Row[]} rows @returns {string[]} */
  function scenesOf(rows) {
    /** @type {string[]} */
    var names = [];
    rows.forEach(function (row) { if (names.indexOf(row.scene) < 0) names.push(row.scene); });
    return names;
  }

  /** @param {Row} doc @param {Look} look @returns {Chart[]} */
  function scenes(doc, look) {
    var names = scenesOf(doc.scenes);
    if (names.length === 0) return [];
    var ink = inks(look);
    var colours = look.dark ? hues.dark : hues.light;
    /** @type {Record<string, number>} */
    var least = {};
    /** @type {string[]} */
    var ways = [];
    doc.scenes.forEach(function (/** @type {Row} */ row) {
      if (row.way === reference) least[row.scene] = row.wall_us_min;
      else if (ways.indexOf(row.way) < 0) ways.push(row.way);
    });
    var series = ways.map(function (way, place) {
      var product = way.indexOf('worth') >= 0;
      var color = colours[product ? 0 : place === 0 ? 10 : 1];
      return {
        type: 'scatter', name: way, symbol: symbols[place], symbolSize: product ? 14 : 11, z: product ? 5 : 3, itemStyle: { color: color },
        data: doc.scenes.filter(function (/** @type {Row} */ row) { return row.way === way; }).map(function (/** @type {Row} */ row) {
          var ratio = row.wall_us_min / least[row.scene];
          return { value: [ratio, names.indexOf(row.scene)], box: box(row, [escaped(way), row.constraints + ' constraints in ' + row.islands + ' islands', short(ratio) + ' × the time of colours on 1 thread']) };
        }),
      };
    });
    /** @type {any} */ (series[0]).markLine = { silent: true, symbol: 'none', label: { show: false }, lineStyle: { color: ink.text, type: 'solid', width: 1 }, data: [{ xAxis: 1 }] };
    var span = ratios(look, doc.scenes.map(function (/** @type {Row} */ row) { return row.wall_us_min / least[row.scene]; }));
    span.nameGap = 28;
    var more = across(look, names, '←  faster     time, × colours on 1 thread     slower  →', span, series);
    return [{
      name: 'scenes', section: 'scenes', choice: 'Scenes', title: 'What colours and threads do to each scene', caption: '', failures: [],
      height: (look.narrow ? 160 : 130) + 34 * names.length, option: option(look, 'What colours and threads do to each scene', [], more),
    }];
  }

  /** @param {Row} doc @param {Look} look @returns {Chart[]} */
  function leftovers(doc, look) {
    var names = scenesOf(doc.scenes);
    if (names.length === 0) return [];
    var ink = inks(look);
    var colours = look.dark ? hues.dark : hues.light;
    var rows = doc.scenes.filter(function (/** @type {Row} */ row) { return row.way.indexOf('worth') >= 0; });
    /** @param {string} name @param {string} color @param {(row: Row) => number} share @param {boolean} stacked */
    function bars(name, color, share, stacked) {
      return {
        type: 'bar', name: name, stack: stacked ? 'all' : undefined, itemStyle: { color: color }, barMaxWidth: 18,
        data: rows.map(function (/** @type {Row} */ row) {
          var value = 100 * share(row);
          return { value: [value, names.indexOf(row.scene)], box: box(row, [escaped(name) + ': ' + short(value) + ' %', row.constraints + ' constraints, ' + row.colours + ' colours in ' + row.islands + ' islands']) };
        }),
      };
    }
    var percent = { type: 'value', nameGap: 28, min: 0, max: 100, axisLabel: { color: ink.faint, formatter: '{value} %' } };
    var left = [
      bars('side by side, in colours', colours[0], function (row) { return 1 - row.overflow_share - row.hub_share; }, true),
      bars('hubs, in buckets', colours[3], function (row) { return row.hub_share; }, true),
      bars('overflow, one by one', colours[9], function (row) { return row.overflow_share; }, true)];
    var waits = [bars('waiting', colours[1], function (row) { return row.waited_share || 0; }, false)];
    return [
      { name: 'overflow', section: 'overflow', choice: 'Overflow', title: 'What does not fit into colours', caption: '', failures: [],
        height: (look.narrow ? 160 : 130) + 30 * names.length,
        option: option(look, 'Share of the constraints in colours, hub buckets and overflow', [], across(look, names, 'share of the constraints', percent, left)) },
      { name: 'waiting', section: 'waiting', choice: 'Waiting', title: 'How long two threads wait', caption: '', failures: [],
        height: (look.narrow ? 160 : 130) + 30 * names.length,
        option: option(look, 'Share of two threads’ time in which they wait for each other', [], across(look, names, 'share of the two threads’ time', percent, waits)) }];
  }

  /**
   * Whether a row of prices ended otherwise than in another run, or than on one thread. Of what
   * failed nobody wants to know. @param {Row} doc @param {Row} row @returns {boolean}
   */
  function unsteady(doc, row) {
    if (row.failure !== '') return false;
    return row.different_hashes > 1 || doc.prices.some(function (/** @type {Row} */ other) {
      return other.scene === row.scene && other.method === row.method && other.threads === 1 && other.failure === '' && other.hash !== row.hash;
    });
  }

  /** @param {Row} doc @param {Look} look @returns {Chart[]} */
  function prices(doc, look) {
    var ink = inks(look);
    return scenesOf(doc.prices).map(function (scene) {
      var all = doc.prices.filter(function (/** @type {Row} */ row) { return row.scene === scene; });
      var failed = all.filter(function (/** @type {Row} */ row) { return row.failure !== ''; });
      var good = all.filter(function (/** @type {Row} */ row) { return row.failure === ''; });
      var joints = good.every(function (/** @type {Row} */ row) { return row.max_penetration_m === 0; });
      /** @param {Row} row */
      function errorOf(row) { return joints ? row.max_joint_error_m : row.max_penetration_m; }
      var least = leastOf(good.map(errorOf));
      var series = methodsIn(doc, good).map(function (/** @type {string} */ name) {
        var style = styleOf(doc, name, look);
        var these = good.filter(function (/** @type {Row} */ row) { return row.method === name; });
        these.sort(function (/** @type {Row} */ a, /** @type {Row} */ b) { return a.threads - b.threads; });
        return {
          type: 'line', name: style.label, symbol: style.symbol, z: style.product ? 5 : 3,
          itemStyle: { color: style.color }, lineStyle: { color: style.color, width: 1.2, type: 'dashed' }, emphasis: { focus: 'series' },
          data: these.map(function (/** @type {Row} */ row) {
            return {
              value: [Math.max(errorOf(row), least), row.wall_us_min], symbolSize: style.size + 4,
              itemStyle: row.threads === 1 ? { color: ink.paper, borderColor: style.color, borderWidth: 2 } : { color: style.color },
              label: legible(look, { distance: 5, show: true, position: 'right', fontSize: 10, color: style.color, formatter: String(row.threads) + (unsteady(doc, row) ? ' ≠' : '') }),
              box: box(row, [(joints ? 'joint error ' : 'penetration ') + short(errorOf(row)) + ' m at the end']),
            };
          }),
        };
      });
      var more = zoom(look, 'xy');
      var spanX = decades(good.map(errorOf).concat(least));
      var spanY = decades(good.map(function (/** @type {Row} */ row) { return row.wall_us_min; }));
      more.xAxis = axis(look, (joints ? 'largest joint error' : 'largest penetration') + ', m  →  worse', { type: 'log', nameGap: 28, min: spanX.min, max: spanX.max, axisLabel: { color: ink.faint, formatter: decade } });
      more.yAxis = axis(look, 'time a step by the clock, µs  →  slower', { type: 'log', nameGap: look.narrow ? 34 : 48, min: spanY.min, max: spanY.max, axisLabel: { color: ink.faint, formatter: decade } });
      more.graphic = [better(look, '↙ better')];
      more.series = series;
      var failures = failureList(doc, failed);
      return {
        name: 'prices-' + scene.replace(/[^a-z0-9]+/gi, '-'), section: 'prices', choice: scene, title: 'What sharing costs: ' + scene,
        caption: '', failures: failures, height: look.narrow ? 470 : 440,
        option: option(look, 'What ways to share work cost: ' + scene + ', 1 and 2 threads', failures, more),
      };
    });
  }

  // ---- effort by need

  /** @param {Row} doc @param {Look} look @returns {Chart[]} */
  function effort(doc, look) {
    var names = scenesOf(doc.effort);
    if (names.length === 0) return [];
    var ink = inks(look);
    var colours = look.dark ? hues.dark : hues.light;
    /** @type {Record<string, number>} */
    var standard = {};
    /** @type {Record<string, any>} */
    var least = {};
    doc.effort.forEach(function (/** @type {Row} */ row) { if (row.substeps === doc.standard_substeps) standard[row.scene] = row.cpu_us_min; });
    doc.effort_answers.forEach(function (/** @type {Row} */ row) { least[row.scene] = row.least_fixed_substeps; });
    /** @param {string} name @param {Option} style @param {(row: Row) => boolean} chosen */
    function dots(name, style, chosen) {
      return {
        type: 'scatter', name: name, symbol: style.symbol, symbolSize: style.size, z: style.z, itemStyle: style.item,
        data: doc.effort.filter(chosen).map(function (/** @type {Row} */ row) {
          var ratio = row.cpu_us_min / standard[row.scene];
          return {
            value: [ratio, names.indexOf(row.scene)],
            label: { show: row.substeps > 0, formatter: String(row.substeps), fontSize: 9, color: style.ink },
            box: box(row, [(row.met ? 'meets' : 'misses') + ' the need of ' + short(1000 * row.need_m) + ' mm: overlap ' + short(1000 * row.max_penetration_m) + ' mm, joints ' + short(1000 * row.max_joint_error_m) + ' mm', short(ratio) + ' × the time of n = ' + doc.standard_substeps]),
          };
        }),
      };
    }
    /** @param {Row} row */
    function isLeast(row) { return row.substeps > 0 && row.substeps === least[row.scene]; }
    var series = [
      dots('fixed, need missed', { symbol: 'circle', size: 15, z: 2, item: { color: 'transparent', borderColor: ink.bad, borderWidth: 1.5 }, ink: ink.bad }, function (row) { return row.substeps > 0 && !row.met; }),
      dots('fixed, need met', { symbol: 'circle', size: 15, z: 2, item: { color: 'transparent', borderColor: ink.faint, borderWidth: 1.5 }, ink: ink.faint }, function (row) { return row.substeps > 0 && row.met && !isLeast(row); }),
      dots('smallest fixed n that meets it', { symbol: 'circle', size: 17, z: 3, item: { color: colours[3] }, ink: ink.paper }, isLeast)];
    series.push(dots('planned, need met', { symbol: 'diamond', size: 17, z: 5, item: { color: colours[0] }, ink: ink.paper }, function (row) { return row.planned && row.met; }));
    series.push(dots('planned, need missed', { symbol: 'diamond', size: 17, z: 5, item: { color: ink.bad }, ink: ink.paper }, function (row) { return row.planned && !row.met; }));
    /** @type {any} */ (series[0]).markLine = { silent: true, symbol: 'none', label: { show: false }, lineStyle: { color: ink.text, width: 1, type: 'solid' }, data: [{ xAxis: 1 }] };
    var span = ratios(look, doc.effort.map(function (/** @type {Row} */ row) { return row.cpu_us_min / standard[row.scene]; }));
    span.nameGap = 28;
    var more = across(look, names, '←  faster     CPU time, × n = ' + doc.standard_substeps + '     slower  →', span, series);
    return [{
      name: 'effort', section: 'effort', choice: 'Effort', title: 'Effort by need', caption: '', failures: [], height: (look.narrow ? 160 : 130) + 34 * names.length,
      option: option(look, 'Time of each number of substeps, and whether the need is met', [], more),
    }];
  }

  // ---- stability, as a picture: the page has a table

  /** @param {Row} doc @param {Look} look @returns {Chart[]} */
  function stability(doc, look) {
    var rows = stabilityRows(doc);
    if (rows.length === 0) return [];
    var ink = inks(look);
    var methods = methodsIn(doc, doc.stability);
    /** @type {any[]} */
    var good = [];
    /** @type {any[]} */
    var bad = [];
    rows.forEach(function (row, y) {
      methods.forEach(function (/** @type {string} */ name, /** @type {number} */ x) {
        var cell = row.cells[name];
        if (!cell || !cell.judged) return;
        (cell.pass ? good : bad).push({ value: [x, y], label: { show: true, color: '#ffffff', fontSize: 10, formatter: cell.frontier > 0 ? 'n ≥ ' + cell.frontier : cell.frontier === 0 ? 'none' : '' } });
      });
    });
    var wide = Math.max(24, Math.min(86, 640 / methods.length));
    return [{
      name: 'stability', section: 'stability', choice: 'Stability', title: 'Stability', caption: '', failures: [], height: 150 + 24 * rows.length,
      option: option(look, 'Stability suite: which method passes which row', [], {
        grid: { left: 190, right: 20, top: 110, bottom: 40 },
        legend: { bottom: 6, left: 'center', textStyle: { color: ink.text } },
        xAxis: axis(look, '', { type: 'category', position: 'top', data: methods, axisLabel: { color: ink.text, rotate: 35, interval: 0 }, splitLine: { show: false } }),
        yAxis: axis(look, '', { type: 'category', inverse: true, data: rows.map(function (row) { return row.row + ' ' + row.name; }), axisLabel: { color: ink.text, interval: 0 }, splitLine: { show: false } }),
        series: [
          { type: 'scatter', name: 'passes', symbol: 'rect', symbolSize: [wide, 20], itemStyle: { color: '#0f766e' }, data: good },
          { type: 'scatter', name: 'fails', symbol: 'rect', symbolSize: [wide, 20], itemStyle: { color: '#b91c1c' }, data: bad }],
      }),
    }];
  }

  /**
   * The table's rows: of each row and method whether it passes, its worst verdict, its frontier.
   * @param {Row} doc
   * @returns {{row: number, name: string, cells: Record<string, Row>}[]}
   */
  function stabilityRows(doc) {
    /** @type {{row: number, name: string, cells: Record<string, any>}[]} */
    var rows = [];
    doc.stability.forEach(function (/** @type {Row} */ verdict) {
      var row = rows.filter(function (r) { return r.row === verdict.row; })[0];
      if (!row) {
        row = { row: verdict.row, name: verdict.name || '', cells: {} };
        rows.push(row);
      }
      var cell = row.cells[verdict.method];
      if (!cell) cell = row.cells[verdict.method] = { pass: true, judged: false, frontier: -1, verdicts: [] };
      cell.verdicts.push(verdict);
      if (!verdict.judged) return;
      cell.judged = true;
      if (!verdict.pass) cell.pass = false;
      // A row's frontier is that of its hardest scene; none of one is none of all.
      if (verdict.frontier === null) return;
      if (verdict.frontier === 0 || cell.frontier === 0) cell.frontier = 0;
      else cell.frontier = Math.max(cell.frontier, verdict.frontier);
    });
    rows.sort(function (a, b) { return a.row - b.row; });
    return rows;
  }

  /** All charts but the table of stability. @param {Row} doc @param {Look} look @returns {Chart[]} */
  function charts(doc, look) {
    return [].concat(
      /** @type {any} */ (work(doc, look)), /** @type {any} */ (overall(doc, look)), /** @type {any} */ (sizes(doc, look)),
      /** @type {any} */ (scenes(doc, look)), /** @type {any} */ (prices(doc, look)), /** @type {any} */ (leftovers(doc, look)),
      /** @type {any} */ (effort(doc, look)));
  }

  /**
   * One function a picture: each takes a while, and whoever draws them may be told to stop.
   * @param {any} library ECharts @param {Row} doc @returns {(() => {name: string, svg: string})[]}
   */
  function pictures(library, doc) {
    /** @type {Look} */
    var look = { dark: false, narrow: false, picture: true };
    return charts(doc, look).concat(stability(doc, look)).map(function (chart) {
      return function () {
        var drawing = library.init(null, null, { renderer: 'svg', ssr: true, width: 1000, height: chart.height + 60 });
        drawing.setOption(chart.option);
        var svg = drawing.renderToSVGString();
        drawing.dispose();
        return { name: chart.name, svg: svg };
      };
    });
  }

  return {
    charts: charts, pictures: pictures, stabilityRows: stabilityRows, methodsIn: methodsIn,
    groups: groups, unsteady: unsteady, busy: busy, short: short, time: time, inUnit: inUnit, who: who,
  };
})();
