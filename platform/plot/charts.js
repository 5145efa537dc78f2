// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
// Draws a page's charts from the element `chart-data`.
/* global Dygraph */
"use strict";

const COLOURS = ["#1f8fd1", "#d55e00", "#009e73", "#cc79a7", "#c98a00", "#7a5cc0", "#8a8a3c",
  "#7f8790"];

const charts = [];

const paint = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

const as_html = (text) => {
  const element = document.createElement("span");
  element.textContent = text;
  return element.innerHTML;
};

/// Position of x between the left and the right end: 0 to 1.
function share_of(graph, x) {
  const [low, high] = graph.xAxisRange();
  return graph.is_series ? (x - low) / (high - low) : Math.log(x / low) / Math.log(high / low);
}

/// Draws the marks below the lines, faults last. The more marks, the paler, so that they hide
/// nothing.
function draw_marks(canvas, area, graph, marks) {
  for (const kind of ["plain", "warning", "fault"]) {
    const shares = marks.filter((mark) => mark.kind === kind).flatMap((mark) => mark.x)
      .map((x) => share_of(graph, x)).filter((share) => share >= 0 && share <= 1);
    canvas.strokeStyle = paint(`--${kind}`);
    canvas.globalAlpha = Math.max(0.15, Math.min(0.7, area.w / (8 * shares.length)));
    canvas.setLineDash(kind === "plain" ? [3, 3] : []);
    canvas.beginPath();
    for (const share of shares) {
      canvas.moveTo(area.x + share * area.w, area.y);
      canvas.lineTo(area.x + share * area.w, area.y + area.h);
    }
    canvas.stroke();
  }
  canvas.setLineDash([]);
  canvas.globalAlpha = 1;
}

/// Legend of the vertical lines, for instance "overrun: 3".
function name_marks(parent, marks) {
  for (const { name, kind, x } of marks) {
    const line = document.createElement("span");
    line.textContent = `| ${name}${x.length > 1 ? `: ${x.length}` : ""}`;
    line.style.color = `var(--${kind})`;
    parent.append(line, " ");
  }
}

/// Applies the zoom and position of one series to all others.
let is_following = false;
function follow(graph) {
  if (is_following) {
    return;
  }
  is_following = true;
  const range = graph.isZoomed("x") ? graph.xAxisRange() : null;
  for (const other of charts) {
    if (other !== graph && other.is_series) {
      other.updateOptions({ dateWindow: range });
    }
  }
  is_following = false;
}

function make(element, chart) {
  const is_series = chart.kind === "series";
  const figure = element.parentElement;
  const line = { gridLineColor: paint("--grid"), axisLineColor: paint("--ink") };
  const rows = chart.x.map((x, i) => [x, ...chart.lines.map((l) => l.y[i])]);
  const graph = new Dygraph(element, rows, {
    labels: [chart.x_label, ...chart.lines.map((l) => l.name)],
    colors: COLOURS,
    xlabel: as_html(chart.x_label),
    ylabel: as_html(chart.y_label),
    labelsDiv: figure.querySelector(".legend"),
    legend: "always",
    stepPlot: !is_series,
    logscale: !is_series,
    includeZero: is_series,
    strokeWidth: 1.5,
    axisLabelFontSize: 12,
    xLabelHeight: 16,
    yLabelWidth: 16,
    animatedZooms: false,
    axes: { x: { logscale: !is_series, drawGrid: !is_series }, y: { axisLabelWidth: 56 } },
    underlayCallback: (canvas, area, self) => {
      self.is_series = is_series;
      draw_marks(canvas, area, self, chart.marks);
    },
    drawCallback: (self, is_first) => {
      if (is_series && !is_first) {
        follow(self);
      }
    },
    ...line,
  });
  name_marks(figure.querySelector(".marks"), chart.marks);
  charts.push(graph);
}

const data = JSON.parse(document.getElementById("chart-data").textContent);
document.querySelectorAll(".chart").forEach((element, i) => make(element, data[i]));
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
  for (const graph of charts) {
    graph.updateOptions({ gridLineColor: paint("--grid"), axisLineColor: paint("--ink") });
  }
});
