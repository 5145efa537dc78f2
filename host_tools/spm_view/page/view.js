// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
import { History } from "./history.js";
import { Player } from "./player.js";
import { Plots } from "./plots.js";
import { NoView, View, ramp } from "./scene.js";

const by_id = (id) => document.getElementById(id);
const now_s = () => performance.now() / 1e3;
const PLOT_PERIOD_S = 0.5;

const history = new History();
const view = make_view();
const plots = new Plots(by_id("plots"));
const choice = { controller: "", object: "", tool: 0, shells: false, level: "",
  regions: false };
let events = null;
let frozen_s = null; // Moment chosen by the user, in s; null: the present.
let plot_again_s = 0;
let connection = "connecting to spm_view";
let player = null; // Player of recordings; null if data are live.

function make_view() {
  try {
    return new View(by_id("canvas"), () => show());
  } catch (fault) {
    return new NoView();
  }
}

function listen() {
  if (events) {
    events.close();
  }
  const source = new EventSource(`/events?controller=${encodeURIComponent(choice.controller)}`);
  events = source;
  source.onmessage = (event) => {
    connection = "";
    history.add(JSON.parse(event.data), now_s());
    if (frozen_s === null) {
      show();
    } else {
      show_when(frozen_s);
    }
  };
  source.onerror = async () => {
    connection = "spm_view does not answer; trying again";
    if (source.readyState === EventSource.CLOSED && source === events) {
      connection = "4 viewers are connected already; close one";
      setTimeout(() => source === events && listen(), 5000);
    }
    show();
  };
}

/// Sets the options of a select element, unless it already has them.
function offer(select, entries, chosen) {
  const wanted = JSON.stringify(entries);
  if (select.dataset.entries !== wanted) {
    select.dataset.entries = wanted;
    select.replaceChildren(...entries.map(([value, text]) => new Option(text, value)));
  }
  select.value = chosen;
}

function figure(list, name, value) {
  const card = document.createElement("div");
  const term = document.createElement("dt");
  const text = document.createElement("dd");
  term.textContent = name;
  text.textContent = value;
  card.append(term, text);
  list.push(card);
}

const micro = (times, name) => (times ? `${times[name][0].toFixed(1)} µs` : "-");
const NO_DEADLINES = { missed: "-", overruns: "-", latency_misses: "-" };

function show_figures(controller) {
  const list = [];
  if (controller) {
    const times = controller.front && controller.front.times_us;
    const answers = controller.answers;
    const frames = Math.max(controller.frame, 1);
    const percent = (count) => `${(100 * count / frames).toFixed(2)} %`;
    figure(list, "frames", controller.frame.toLocaleString("en"));
    figure(list, "rate", `${(1e6 / controller.period_us).toFixed(0)} Hz`);
    figure(list, "frame, mean", micro(times, "frame"));
    figure(list, "frame, longest", times ? `${times.frame[1].toFixed(0)} µs` : "-");
    figure(list, "exact", percent(answers.exact));
    figure(list, "separated", percent(answers.separated));
    figure(list, "within tolerance", percent(answers.within_tolerance));
    figure(list, "bounded", percent(answers.bounded));
    figure(list, "stale", percent(answers.stale));
    const deadlines = controller.deadlines || NO_DEADLINES;
    figure(list, "missed", deadlines.missed);
    figure(list, "overruns", deadlines.overruns);
    figure(list, "latency misses", deadlines.latency_misses);
    figure(list, "flags", controller.faults.join(", ") || "none");
  }
  by_id("figures").replaceChildren(...list);
}

function show_words(controller) {
  const tool = controller && controller.tools[choice.tool];
  const words = by_id("words");
  if (!tool) {
    words.textContent = controller ? "no tool" : "no controller";
    words.dataset.state = "none";
    return;
  }
  const newton = Math.hypot(...tool.force_n).toFixed(2);
  words.textContent = tool.words === null ? `force ${newton} N` :
    `force ${newton} N, ${tool.words}`;
  words.dataset.state = tool.words === null ? "none" : tool.words.slice(0, 3).trim()
    .replace(":", "");
}

function show_choices(state) {
  const controller = state.controller;
  offer(by_id("controller"),
    state.controllers.length > 0 ? state.controllers.map((c) => [c.id, c.name]) : [["", "none"]],
    controller ? controller.id : choice.controller);
  const front = controller && controller.front;
  const objects = front ? front.objects : [];
  const name_of = (object) => {
    const model = controller.models.find((m) => m.hash === object.model);
    const shows = model ? model.name : object.model.slice(0, 8);
    return `${object.object}: ${object.name && object.name !== shows ?
      `${object.name} (${shows})` : shows}`;
  };
  offer(by_id("object"),
    [["", "all"], ...objects.map((o) => [`${o.server}/${o.object}`, name_of(o)])], choice.object);
  const tools = controller ? controller.tools : [];
  const shape_of = (tool) => tool.shape.replace(/\d+\.\d+/g, (size) =>
    Number(Number(size).toPrecision(3)));
  offer(by_id("tool"), tools.map((tool, i) => [i, tool.shape ? `${i}: ${shape_of(tool)}` : `${i}`]),
    choice.tool);
}

function show_legend(waits, left_out) {
  const { scale, faces, boxes, regions, fault } = view.summary();
  by_id("legend").hidden = !scale;
  by_id("regions-legend").hidden = !regions;
  for (const [name, text] of Object.entries(regions || {})) {
    by_id(`regions-${name}`).textContent = text;
  }
  by_id("least").textContent = scale ? scale.least : "";
  by_id("most").textContent = scale ? scale.most : "";
  by_id("faces").textContent = faces > 0 ? `${faces.toLocaleString("en")} faces` +
    (boxes > 0 ? `, ${boxes.toLocaleString("en")} boxes` : "") +
    (left_out > 0 ? `; may be coarser than in the controller: ` +
      `${left_out.toLocaleString("en")} page slots are not sent` : "") : "";
  by_id("waits").textContent = connection || fault || (waits ? `waiting for ${waits}` : "");
}

function show_when(time_s) {
  const back_s = Math.max(now_s() - time_s, 0).toFixed(1);
  by_id("when").textContent = frozen_s === null ? "live" : `${back_s} s ago`;
}

/// Time of the shown moment, in s.
function shown_s() {
  return player ? player.time_s() : frozen_s === null ? now_s() : frozen_s;
}

function show_player() {
  const { frame, film } = player;
  by_id("play").textContent = player.plays ? "stop" : "play";
  by_id("play").setAttribute("aria-pressed", String(player.plays));
  by_id("frame").value = String(frame);
  by_id("place").textContent = `${player.time_s().toFixed(3)} s, frame ` +
    `${frame.toLocaleString("en")} of 0 to ${(film.frames - 1).toLocaleString("en")}`;
}

function show() {
  const time_s = shown_s();
  const entry = history.at(time_s);
  const state = entry ? entry.state : { controllers: [], controller: null, waits_for: "" };
  show_choices(state);
  show_figures(state.controller);
  show_words(state.controller);
  view.show(state.controller, choice);
  const front = state.controller && state.controller.front;
  show_legend(state.waits_for, front ? front.slots_left_out : 0);
  show_when(time_s);
  if (player) {
    show_player();
  }
  if (now_s() > plot_again_s) {
    const begin_s = now_s();
    plots.show(history.entries, choice.tool, time_s);
    const end_s = now_s();
    plot_again_s = end_s + Math.max(PLOT_PERIOD_S, 3 * (end_s - begin_s));
  }
}

function look_at(time_s) {
  frozen_s = time_s;
  by_id("freeze").setAttribute("aria-pressed", String(time_s !== null));
  by_id("freeze").textContent = time_s === null ? "freeze" : "continue";
  if (time_s === null) {
    by_id("back").value = "0";
  }
  plot_again_s = 0;
  show();
}

/// Shows the differences of two recordings, each with a link, and why a recording ends early.
function show_notes(film) {
  const notes = by_id("film-notes");
  const lines = film.films.filter((each) => each.note !== "").map((each) =>
    `${each.name}: ${each.note}`);
  if (film.films.length > 1) {
    const names = film.films.map((each) => each.name).join(" and ");
    lines.unshift(film.differences.length > 0 ? `${names} differ; the first difference of each kind:` :
      `${names}: every frame is the same`);
  }
  const paragraphs = lines.map((line) => {
    const paragraph = document.createElement("p");
    paragraph.textContent = line;
    return paragraph;
  });
  const ways = film.differences.map((difference) => {
    const way = document.createElement("button");
    way.type = "button";
    way.textContent = `frame ${difference.frame.toLocaleString("en")}: ${difference.what}, ` +
      difference.how;
    way.addEventListener("click", () => {
      player.play(false);
      player.go_to(difference.frame);
    });
    return way;
  });
  notes.replaceChildren(...paragraphs, ...ways);
  notes.hidden = lines.length === 0;
}

function play(state) {
  connection = "";
  player = new Player(state.film, (states, is_leap, fault) => {
    connection = fault;
    if (is_leap) {
      history.clear();
      plot_again_s = 0;
    }
    for (const each of states) {
      history.add(each, player.time_s(each.serial));
    }
    show();
  });
  by_id("live-bar").hidden = true;
  by_id("film-bar").hidden = false;
  by_id("frame").max = String(state.film.frames - 1);
  show_notes(state.film);
  by_id("play").addEventListener("click", () => { player.play(!player.plays); show(); });
  by_id("step-back").addEventListener("click", () => player.step(-1));
  by_id("step-on").addEventListener("click", () => player.step(1));
  by_id("speed").addEventListener("change", (event) => { player.speed = Number(event.target.value); });
  by_id("frame").addEventListener("input", (event) => player.go_to(Number(event.target.value)));
  document.addEventListener("keydown", (event) => {
    const ways = { ArrowLeft: () => player.step(-1), ArrowRight: () => player.step(1),
      " ": () => { player.play(!player.plays); show(); } };
    if (ways[event.key] && !/^(SELECT|INPUT|BUTTON)$/.test(event.target.tagName)) {
      event.preventDefault();
      ways[event.key]();
    }
  });
  player.go_to(0);
}

/// Begins with live data or recordings, according to the first answer of the server.
function begin() {
  fetch("/state").then((answer) => answer.json()).then((state) => {
    if (state.film) {
      play(state);
    } else {
      listen();
    }
  }).catch(() => {
    connection = "spm_view does not answer; trying again";
    show();
    setTimeout(begin, 2000);
  });
}

function paint_ramp() {
  const canvas = by_id("ramp");
  const pen = canvas.getContext("2d");
  for (let x = 0; x < canvas.width; ++x) {
    pen.fillStyle = `rgb(${ramp(x / canvas.width).map((c) => Math.round(255 * c)).join(",")})`;
    pen.fillRect(x, 0, 1, canvas.height);
  }
}

function take_theme(theme) {
  document.documentElement.dataset.theme = theme;
  plots.take_colours();
}

by_id("controller").addEventListener("change", (event) => {
  Object.assign(choice, { controller: event.target.value, object: "", tool: 0 });
  if (player) {
    player.choose(choice.controller);
    return;
  }
  history.clear();
  view.forget();
  listen();
});
by_id("object").addEventListener("change", (event) => { choice.object = event.target.value; show(); });
by_id("tool").addEventListener("change", (event) => { choice.tool = Number(event.target.value); show(); });
by_id("colour").addEventListener("change", (event) => { view.recolour(event.target.value); show(); });
by_id("edges").addEventListener("change", (event) => { view.edges = event.target.checked; show(); });
by_id("shells").addEventListener("change", (event) => { choice.shells = event.target.checked; show(); });
by_id("regions").addEventListener("change", (event) => { choice.regions = event.target.checked; show(); });
by_id("level").addEventListener("change", (event) => { choice.level = event.target.value; show(); });
by_id("fit").addEventListener("click", () => view.fit());
by_id("near").addEventListener("click", () => view.follow(choice.tool));
by_id("theme").addEventListener("click", () =>
  take_theme(document.documentElement.dataset.theme === "dark" ? "light" : "dark"));
by_id("freeze").addEventListener("click", () => look_at(frozen_s === null ? now_s() : null));
by_id("back").addEventListener("input", (event) => {
  const back_s = Number(event.target.value);
  look_at(back_s === 0 ? null : now_s() + back_s);
});

take_theme(new URLSearchParams(location.search).get("theme") ||
  (window.matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light"));
paint_ramp();
begin();
show();
