#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright the Tactus authors.
"""Draws the pictures of docs/benchmarks.md from the results beside them.

    plots.py draw FOLDER     FOLDER/*.svg anew, from FOLDER/*.json
    plots.py check FOLDER    whether they are what would be drawn

Needs python3-matplotlib; the same version and results give the same bytes.
Exit codes: 0 done, 1 a picture is another, 2 failed, 3 usage, 77 the matplotlib of DRAWN_BY is not
here to check with.
"""

import io
import pathlib
import re
import sys

import results

try:
    import matplotlib
    matplotlib.use("svg")
    from matplotlib import pyplot, ticker
except ImportError:
    matplotlib = None

DRAWN_BY = "3.6.3"  # Version of Debian 12; another one may place a line elsewhere.
COLOURS = {"Tactus": "#0072b2", "static": "#56b4e9", "goal": "#000000", "Embree": "#e69f00",
           "CGAL": "#009e73", "FCL": "#cc79a7", "sphere": "#882255", "Bullet": "#d55e00",
           "OpenMesh": "#999933", "meshoptimizer": "#7f7f7f"}
QUANTILES = {"p50": "o", "p99": "D", "max": "^"}
EXACT = 1e-9  # Place of an error of 0 on a logarithmic axis, in diagonals.
# Ends of the axis of `memory`: exact, and a tool that waits for data.
LEAST_UM, WAITS_UM = 0.1, 1000.0


class Results:
    """Rows of all files of the folder."""

    def __init__(self, folder):
        self.rows = [row for path in sorted(folder.glob("*.json"))
                     for row in results.read(path)["rows"]]

    def found(self, suite, **wanted):
        return [row for row in self.rows if row["suite"] == suite and row["value"] is not None
                and all(row.get(key, "") == value for key, value in wanted.items())]

    def names(self, key, suite, **wanted):
        """Different names under that key, in order."""
        names = list(dict.fromkeys(row[key] for row in self.found(suite, **wanted)))
        if not names:
            raise results.Failure(f"no rows of {suite} with {wanted}")
        return names

    def value(self, suite, key="value", **wanted):
        """Value of a row; None if there is none."""
        found = [row[key] for row in self.found(suite, **wanted) if key in row]
        return found[0] if found else None

    def quantiles(self, suite, form="{}", key="value", **wanted):
        return [self.value(suite, key, metric=form.format(one), **wanted) for one in QUANTILES]

    def line(self, suite, key, names, **wanted):
        """Value for each name; NaN if there is none."""
        values = [self.value(suite, **wanted, **{key: name}) for name in names]
        return [float("nan") if value is None else value for value in values]


def colour(name):
    """Colour of the contestant, by the last known word of its name."""
    known = [word for word in COLOURS if word in name]
    return COLOURS[known[-1]] if known else "#444444"


def axes_of(columns, height, **more):
    figure, axes = pyplot.subplots(1, columns, figsize=(9.6, height), squeeze=False, **more)
    figure.subplots_adjust(left=0.14, right=0.98, top=1 - 0.34 / height, bottom=0.85 / height,
                           wspace=0.38)
    return figure, axes[0]


def by_powers(axis):
    """Plain ticks: 0.5, 1, 2, 5 ..., only powers of ten on a long axis."""
    getattr(axis.axes, f"set_{axis.axis_name}scale")("log")
    low, high = axis.get_view_interval()
    axis.set_major_locator(ticker.LogLocator(subs=(1, 2, 5) if high < 200 * low else (1,)))
    axis.set_major_formatter(ticker.FuncFormatter(
        lambda value, _: f"{value:.10g}" if value < 1e4 else f"{value / 1e3:.10g} k"
        if value < 1e6 else f"{value / 1e6:.10g} M"))
    axis.set_minor_formatter(ticker.NullFormatter())


def legend_below(figure, axes, columns=6):
    """One legend for all axes, each name once."""
    handles = {}
    for one in axes:
        handles.update({name: handle for handle, name in zip(*one.get_legend_handles_labels())})
    figure.legend(handles.values(), handles.keys(), loc="lower center", ncol=columns,
                  frameon=False, handletextpad=0.3, columnspacing=1.2)


def ranges(axes, title, unit, lines, series):
    """One line for each name, with marks for each (name, colours, [p50, p99, max] of each line).

    Colours are one, or a list with one for each line."""
    step = 0.8 / len(series)
    drawn = set()
    for at, (name, colours, values) in enumerate(series):
        shades = [colours] * len(lines) if isinstance(colours, str) else colours
        for line, (of_line, shade) in enumerate(zip(values, shades)):
            y = line + (at - (len(series) - 1) / 2) * step
            known = [value for value in of_line if value is not None]
            axes.plot(known, [y] * len(known), color=shade, linewidth=1)
            for value, quantile in zip(of_line, QUANTILES):
                if value is not None:
                    drawn.add(quantile)
                    axes.plot(value, y, QUANTILES[quantile], color=shade, markersize=5,
                              markerfacecolor="white" if name == "goal" else shade)
        if isinstance(colours, str) and len(series) > 1:
            axes.plot([], [], color=colours, linewidth=4, label=name)
    for name, mark in QUANTILES.items():
        if name in drawn:
            axes.plot([], [], mark, color="#777777", label=name)
    axes.set(title=title, xlabel=unit, yticks=range(len(lines)), yticklabels=lines,
             ylim=(len(lines) - 0.5, -0.5))
    by_powers(axes.xaxis)
    axes.grid(axis="x", color="#dddddd")


def curves(axes, title, x_name, y_name, curves_of):
    """Points (name, colour, x, y), both axes logarithmic."""
    for name, shade, x, y in curves_of:
        axes.plot(x, y, "o-", color=shade, markersize=4, linewidth=1.2, label=name)
    axes.set(title=title, xlabel=x_name, ylabel=y_name)
    by_powers(axes.xaxis)
    by_powers(axes.yaxis)
    axes.grid(color="#dddddd")


def frame(data):
    figure, axes = axes_of(2, 3.6, gridspec_kw={"width_ratios": [1.4, 1]})
    for one, title, form, cases in (
            (axes[0], "a frame that streams", "frame warm.{}",
             data.names("case", "frame", metric="frame warm.p50")),
            (axes[1], "a query near, static", "T_Q near.{}",
             [case for case in data.names("case", "frame", metric="T_Q near.p50")
              if case != "static-growth"])):
        def of(key, form=form, cases=cases):
            return [data.quantiles("frame", form, key, case=case) for case in cases]
        ranges(one, title, "us", cases, [("Tactus", COLOURS["Tactus"], of("value")),
                                         ("goal", COLOURS["goal"], of("goal")),
                                         ("Embree's query, same run", COLOURS["Embree"],
                                          of("peer_value"))])
    legend_below(figure, axes)
    return figure


def points_of(data, case):
    """(by, setting, {metric: value}) of all contestants with the same points."""
    pairs = dict.fromkeys((row["by"], row["setting"])
                          for row in data.found("error_time", case=case, part="", metric="p99"))
    for by, setting in pairs:
        yield by, setting, {row["metric"]: row["value"] for row in
                            data.found("error_time", case=case, part="", by=by, setting=setting)}


def error_time(data):
    figure, axes = axes_of(2, 4.2)
    named = ("usual", "whole model, static")
    for by, setting, values in points_of(data, "bunny-69k"):
        if not {"memory", "error max", "p99"} <= values.keys():
            continue
        error = max(values["error max"], EXACT)
        for one, x in zip(axes, (values["p99"], values["memory"])):
            one.plot(x, error, "o", color=colour(by), markersize=6 if setting in named else 4,
                     label=by, alpha=0.85)
            if setting in named:
                one.annotate(setting, (x, error), (0, 6), textcoords="offset points", ha="center")
    for one, title, name in zip(axes, ("error against time", "error against memory"),
                                ("p99, us", "memory, MB")):
        one.set(title=title, xlabel=name, ylabel="largest error, diagonals; exact at the bottom",
                yscale="log", ylim=(EXACT / 3, 1e-2))
        by_powers(one.xaxis)
        one.margins(x=0.1)
        one.grid(color="#dddddd")
    legend_below(figure, axes)
    return figure


def faces_of(data, case):
    """Faces of the whole mesh: the greatest number in the settings."""
    counts = [int(setting.removesuffix(" faces")) for _, setting, _ in points_of(data, case)
              if setting.endswith(" faces")]
    if not counts:
        raise results.Failure(f"error_time: no peer was asked about {case}")
    return max(counts)


def size(data):
    figure, axes = axes_of(2, 3.8)
    cases = {case: faces_of(data, case) for case in data.names("case", "error_time", part="")}
    cases = dict(sorted(cases.items(), key=lambda item: item[1]))
    who = {"Tactus, streaming": ("Tactus", "usual", "Tactus"),
           "Tactus, static": ("Tactus", "whole model, static", "static"),
           "Embree": ("Embree", None, "Embree"), "CGAL": ("CGAL", None, "CGAL")}
    for one, metric, unit in zip(axes, ("p99", "memory"), ("p99, us", "memory, MB")):
        lines = []
        for name, (by, setting, shade) in who.items():
            values = [data.value("error_time", case=case, part="", by=by, metric=metric,
                                 setting=setting or f"{faces} faces")
                      for case, faces in cases.items()]
            lines.append((name, COLOURS[shade], list(cases.values()),
                          [float("nan") if value is None else value for value in values]))
        curves(one, f"{unit.split(',')[0]} by size of the model", "faces", unit, lines)
    legend_below(figure, axes)
    return figure


def skip(data):
    cases = data.names("case", "skip", metric="p50")
    settings = data.names("setting", "skip", case=cases[0], metric="p50")
    figure, axes = axes_of(len(cases), 3.8)
    figure.subplots_adjust(left=0.24, wspace=0.08)
    for one, case in zip(axes, cases):
        ranges(one, case, "us", settings, [("Tactus", COLOURS["Tactus"],
               [data.quantiles("skip", case=case, setting=setting) for setting in settings])])
        one.label_outer()
    legend_below(figure, axes)
    return figure


def growth(data):
    figure, axes = axes_of(2, 4)
    scenes = data.names("case", "growth", part="frame p50", metric="frame p50")
    faces = [int(scene.rsplit("-", 1)[1]) for scene in scenes]
    kinds = {"frame p50": "us", "frame p99": "us", "query p50": "us", "encoder": "s",
             "pages in the pool": "", "wire": "kB/s"}
    palette = pyplot.get_cmap("tab10")
    curves(axes[0], "Tactus", "faces", "us, s, kB/s, pages",
           [(f"{metric}, {unit}".removesuffix(", "), palette(at), faces,
             data.line("growth", "case", scenes, part=metric, metric=metric))
            for at, (metric, unit) in enumerate(kinds.items())])
    axes[0].legend(fontsize=7, frameon=False)
    wanted = {"part": "W3, scale", "metric": "near p99"}
    settings = data.names("setting", "peers", **wanted)
    counts = [float(text.split()[0]) * {"k": 1e3, "M": 1e6}[text.split()[1]] for text in settings]
    curves(axes[1], "near queries of all, p99", "faces", "us",
           [(by, colour(by), counts, data.line("peers", "setting", settings, by=by, **wanted))
            for by in data.names("by", "peers", **wanted)])
    legend_below(figure, axes[1:])
    return figure


def peers(data):
    figure, axes = axes_of(3, 3.8)
    figure.subplots_adjust(wspace=0.75)
    cases = data.names("case", "peers", part="W1, touch")
    for one, case in zip(axes, cases):
        names = data.names("by", "peers", case=case, metric="near p50")
        values = [data.quantiles("peers", "near {}", case=case, by=by) for by in names]
        ranges(one, f"W1, {case}", "us", names, [("", [colour(name) for name in names], values)])
    part = "W2, mesh tool"
    meshes = data.names("case", "peers", part=part, metric="p50")
    lines = [(case, question) for case in meshes
             for question in data.names("setting", "peers", part=part, case=case, metric="p50")]
    ranges(axes[2], "W2, a mesh as the tool", "us",
           [f"{case.removeprefix('mesh-')}, {question}" for case, question in lines],
           [(by, COLOURS[by],
             [data.quantiles("peers", part=part, case=case, setting=question, by=by)
              for case, question in lines]) for by in ("Tactus", "FCL")])
    legend_below(figure, axes[2:])
    return figure


def force(data):
    figure, axes = axes_of(2, 4.2)
    figure.subplots_adjust(bottom=0.27)
    for one, metric in zip(axes, ("error.p99", "frame.p99")):
        sweeps = [case.split(", ", 2) for case in data.names(
            "case", "force", part="Sweeps", by="Tactus", metric=metric)]
        for mesh, ball in dict.fromkeys((mesh, ball) for mesh, _, ball in sweeps):
            speeds = [speed for a, speed, b in sweeps if (a, b) == (mesh, ball)]
            cases = [f"{mesh}, {speed}, {ball}" for speed in speeds]
            x = [float(speed.split()[0]) for speed in speeds]
            curves(one, "", "speed, m/s", "", [(f"{mesh} triangles, ball of {ball}",
                   "#444444" if "friction" in ball else None, x,
                   data.line("force", "case", cases, by="Tactus", metric=metric))])
    axes[1].axhline(20, color=COLOURS["goal"], linestyle="--", linewidth=1,
                    label="goal of 1.3M, 2 mm")
    axes[0].set(title="error of a force of 1 N, p99", ylabel="N")
    axes[1].set(title="the whole frame, p99", ylabel="us")
    legend_below(figure, axes, 4)
    return figure


def encoder(data):
    figure, axes = axes_of(3, 4.6)
    figure.subplots_adjust(left=0.17, wspace=0.16)
    cases = data.names("case", "encoder", part="Encoder", metric="one core")
    panels = (("encoding", "us a face", "Encoder", {"one core": ("Tactus", ""),
                                                     "two threads": ("static", "")}),
              ("error at 1 % of the faces", "RMS by the peer's", "Simplification",
               {"ours in RMS": ("CGAL", "CGAL Garland-Heckbert"),
                "ours in RMS ": ("meshoptimizer", "meshoptimizer")}),
              ("to the first exact contact", "KB", "First exact contact",
               {"median": ("Tactus", ""), "with hashes, median": ("static", "")}))
    for one, (title, unit, part, metrics) in zip(axes, panels):
        for metric, (shade, by) in metrics.items():
            wanted = {"part": part, "metric": metric.strip(), "by": by}
            values = data.line("encoder", "case", cases, **wanted)
            one.plot(values, range(len(cases)), "o", color=COLOURS[shade],
                     label=by or metric.removeprefix("one core").strip() or "one core")
            goals = [data.value("encoder", "goal", case=case, **wanted) for case in cases]
            one.plot([goal for goal in goals if goal is not None],
                     [at for at, goal in enumerate(goals) if goal is not None], "|",
                     color=COLOURS[shade], markersize=11, markeredgewidth=2)
        one.set(title=title, yticks=range(len(cases)), yticklabels=cases,
                ylim=(len(cases) - 0.5, -0.5))
        by_powers(one.xaxis)
        one.label_outer()
        one.set_xlabel(unit)
        one.grid(color="#dddddd")
    axes[2].plot([], [], "|", color="#444444", markersize=11, markeredgewidth=2,
                 label="goal, at most")
    legend_below(figure, axes, 7)
    return figure


def stream(data):
    figure, axes = axes_of(2, 3.8, gridspec_kw={"width_ratios": [1.5, 1]})
    figure.subplots_adjust(left=0.17, wspace=0.56)
    part = "prediction"
    cases = data.names("case", "stream", part=part)
    for at, by in enumerate(data.names("by", "stream", part=part)):
        axes[0].plot(data.line("stream", "case", cases, part=part, by=by, metric="open"),
                     [line + 0.15 * (at - 2) for line in range(len(cases))],
                     "osD^v"[at % 5], markersize=4.5, label=by)
    tours = data.names("case", "stream", part="tours, whole programs")
    for key, mark, shade in (("value", "o", "Tactus"), ("goal", "|", "goal")):
        found = [data.value("stream", key, case=case, metric="open") for case in tours]
        axes[1].plot([float("nan") if value is None else value for value in found],
                     range(len(tours)), mark, color=COLOURS[shade], markeredgewidth=2,
                     markersize=5 if mark == "o" else 12,
                     label="whole programs" if key == "value" else "goal, at most")
    for one, title, names in ((axes[0], "by prediction", cases),
                              (axes[1], "over DDS, two networks", tours)):
        one.set(title=title, xlabel="frames whose answer is open, %", yticks=range(len(names)),
                yticklabels=[name.removeprefix("1.1M, ") for name in names],
                ylim=(len(names) - 0.5, -0.5))
        one.grid(color="#dddddd")
    axes[0].set_xscale("symlog", linthresh=0.1)
    axes[0].set(xticks=(0, 0.1, 1, 10), xticklabels=("0", "0.1", "1", "10"), xlim=(-0.02, 60))
    legend_below(figure, axes, 7)
    return figure


def memory(data):
    """Error of the touched surface over the size of the pools, and where the tool waits instead."""
    tools = data.names("by", "memory", metric="waits for data")
    pools = data.names("setting", "memory", metric="waits for data")
    figure, axes = axes_of(len(tools), 2.9, sharey=True)
    figure.subplots_adjust(left=0.08, right=0.99, wspace=0.08)
    for one, tool in zip(axes, tools):
        for at, case in enumerate(data.names("case", "memory", by=tool)):
            wanted = {"case": case, "by": tool}
            off = data.line("memory", "setting", pools, metric="surface off by at most", **wanted)
            waits = data.line("memory", "setting", pools, metric="waits for data", **wanted)
            level = [WAITS_UM if share > 1 else max(value, LEAST_UM)
                     for value, share in zip(off, waits)]
            one.plot(range(len(pools)), [value * 1.12 ** (at - 1.5) for value in level],
                     "osD^"[at % 4], color=("#56b4e9", "#0072b2", "#e69f00", "#d55e00")[at % 4],
                     markersize=4, linestyle="-", linewidth=1, label=case)
        one.set(title=tool, xlabel="pools, MiB", yscale="log", ylim=(0.6 * LEAST_UM, 2 * WAITS_UM),
                xticks=range(len(pools)), xticklabels=[pool.split()[0] for pool in pools])
        one.grid(color="#dddddd")
    axes[0].set(ylabel="surface off by at most, um", yticks=(LEAST_UM, 1, 10, 100, WAITS_UM),
                yticklabels=("exact", "1", "10", "100", "waits"))
    axes[0].minorticks_off()
    legend_below(figure, axes, 4)
    return figure


PICTURES = (frame, error_time, size, skip, growth, peers, force, encoder, stream, memory)


def svg(picture, data):
    with pyplot.rc_context({"svg.hashsalt": "tactus", "svg.fonttype": "none", "font.size": 8,
                            "axes.titlesize": 9, "axes.axisbelow": True}):
        figure = picture(data)
        text = io.StringIO()
        figure.savefig(text, format="svg", facecolor="white", metadata={"Date": None,
                                                                        "Creator": None})
        pyplot.close(figure)
    # One line for each drawn element.
    return re.sub(r"\n\s*(?!<g id=|\s)", " ", text.getvalue()).rstrip() + "\n"


def run(arguments, usage, pictures, data_of):
    """Draws or checks them in a folder; each is drawn from the result of `data_of` for that folder.
    """
    if len(arguments) != 2 or arguments[0] not in ("draw", "check"):
        print(usage, file=sys.stderr)
        return 3
    command, folder = arguments[0], pathlib.Path(arguments[1])
    is_check = command == "check"
    if matplotlib is None or (is_check and matplotlib.__version__ != DRAWN_BY):
        print(f"plots.py: there is no python3-matplotlib{' ' + DRAWN_BY if is_check else ''}")
        return 77 if is_check else 2
    try:
        data, code = data_of(folder), 0
        for picture in pictures:
            path, text = folder / f"{picture.__name__}.svg", svg(picture, data)
            if not is_check:
                path.write_text(text, encoding="utf-8")
            elif not path.exists() or path.read_text(encoding="utf-8") != text:
                print(f"{path}: not what would be drawn now; draw it anew")
                code = 1
    except (results.Failure, OSError) as error:
        print(f"plots.py: {error}", file=sys.stderr)
        return 2
    return code


if __name__ == "__main__":
    sys.exit(run(sys.argv[1:], __doc__, PICTURES, Results))
