// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
/* global Dygraph */

/// Shortest time between two points of a plot.
const STEP_S = 0.1;

const norm = (v) => Math.hypot(v[0], v[1], v[2]);

function width_mm(controller, tool) {
  const widths = controller.pairs
    .filter((pair) => pair.tool === tool && pair.upper_m !== null)
    .map((pair) => Number(((pair.upper_m - pair.lower_m) * 1e3).toFixed(6)));
  return widths.length > 0 ? Math.max(...widths) : null;
}

const times = (controller, names) =>
  names.map((name) => (controller.front && controller.front.times_us ?
    controller.front.times_us[name][0] : null));

/// Plots, each with a function from a controller's state to its values; null: no value.
const PLOTS = [
  {
    title: "stages, µs (mean)", labels: ["T_L", "T_R", "T_B", "T_Q", "force"],
    values: (c) => times(c, ["load", "refine", "refit", "query", "force"]),
  },
  {
    title: "force, N", labels: ["force", "torque, mN m"],
    values: (c, tool) => (c.tools[tool] ?
      [norm(c.tools[tool].force_n), norm(c.tools[tool].torque_nm) * 1e3] : [null, null]),
  },
  {
    title: "width of the bounds, mm", labels: ["widest"],
    values: (c, tool) => [width_mm(c, tool)],
  },
  {
    title: "memory, % of the pools", labels: ["pages", "faces"],
    values: (c) => ["pages", "faces"].map((name) => {
      const sum = (part) => c.models.reduce((so_far, m) => so_far + m[name][part], 0);
      return 100 * sum(0) / Math.max(sum(1), 1);
    }),
  },
  {
    title: "budgets per frame", labels: ["splits", "merges", "nodes / 10"],
    values: (c) => (c.front ?
      [c.front.budgets.splits, c.front.budgets.merges, c.front.budgets.nodes / 10] :
      [null, null, null]),
  },
  {
    title: "deadlines missed", labels: ["overruns", "latency misses"],
    values: (c) => (c.deadlines ? [c.deadlines.overruns, c.deadlines.latency_misses] :
      [null, null]),
  },
];

// Dygraph's legend is HTML with inline styles, which the page's Content-Security-Policy refuses.
Dygraph.PLUGINS = Dygraph.PLUGINS.filter((plugin) => plugin !== Dygraph.Plugins.Legend);

const LINES_MAX = 5;

/// Colours of plots in the present theme of the page.
function colours() {
  const style = getComputedStyle(document.documentElement);
  const value = (name) => style.getPropertyValue(name).trim();
  return {
    colors: Array.from({ length: LINES_MAX }, (_, i) => value(`--plot-${i + 1}`)),
    gridLineColor: value("--line"),
    axisLineColor: value("--line"),
  };
}

/// Shows the legend of a plot: each name in its colour, with the newest value.
function show_names(parent, labels, row) {
  parent.replaceChildren(...labels.map((label, i) => {
    const name = document.createElement("span");
    const value = row[i + 1];
    name.style.color = `var(--plot-${i + 1})`;
    name.textContent = value === null ? label : `${label} ${Number(value.toPrecision(3))}`;
    return name;
  }));
}

/// Plots of the last minute; times are in seconds before the newest.
export class Plots {
  constructor(parent) {
    this.parent = parent;
    this.graphs = PLOTS.map((plot) => this.make(plot));
  }

  make(plot) {
    const card = document.createElement("div");
    card.className = "plot";
    const title = document.createElement("h2");
    title.textContent = plot.title;
    const names = document.createElement("div");
    names.className = "names";
    const area = document.createElement("div");
    area.className = "area";
    card.append(title, names, area);
    this.parent.append(card);
    const graph = new Dygraph(area, [[0, ...plot.labels.map(() => null)]], {
      labels: ["s", ...plot.labels],
      ...colours(),
      strokeWidth: 1.4,
      axisLabelFontSize: 11,
      includeZero: true,
      dateWindow: [-60, 0],
      animatedZooms: false,
      axes: {
        x: { valueFormatter: (s) => `${s.toFixed(1)} s`, drawGrid: false },
        y: { axisLabelWidth: 42 },
      },
    });
    return { plot, graph, names };
  }

  /// Draws the minute before `end_s`, the present or the chosen moment on the page's clock.
  show(entries, tool, end_s) {
    const shown = [];
    for (const entry of entries) {
      const last_s = shown.length > 0 ? shown[shown.length - 1].at_s : -Infinity;
      if (entry.state.controller && entry.at_s <= end_s && entry.at_s - last_s >= STEP_S) {
        shown.push(entry);
      }
    }
    for (const { plot, graph, names } of this.graphs) {
      const rows = shown.map(({ state, at_s }) =>
        [at_s - end_s, ...plot.values(state.controller, tool)]);
      if (rows.length > 0) {
        graph.updateOptions({ file: rows });
        show_names(names, plot.labels, rows[rows.length - 1]);
      }
    }
  }

  /// Takes the colours of the page's theme after it changed.
  take_colours() {
    for (const { graph } of this.graphs) {
      graph.updateOptions(colours());
    }
  }
}
