"""page.py - one self-contained HTML page of a run: figures of the summary, pictures, the scene."""

import base64
import html
import os

import style

CSS = """
:root { --back: #ffffff; --card: #f6f8f9; --text: #22303c; --muted: #66727d; --line: #dfe4e8; --accent: #1763a6; }
@media (prefers-color-scheme: dark) {
  :root { --back: #14191e; --card: #1d242b; --text: #e4e9ed; --muted: #98a4ae; --line: #303a43; --accent: #6fb3e6; }
}
* { box-sizing: border-box; }
body { margin: 0; background: var(--back); color: var(--text); font: 16px/1.5 system-ui, "Segoe UI", "DejaVu Sans", sans-serif; }
main { max-width: 1180px; margin: 0 auto; padding: 2rem 1.25rem 4rem; }
h1 { font-size: 2rem; margin: 0 0 .25rem; }
h2 { font-size: 1.25rem; margin: 2.5rem 0 .75rem; }
p.lead { color: var(--muted); margin: 0 0 1.5rem; }
.status { display: inline-block; padding: .1rem .6rem; border-radius: 1rem; border: 1px solid currentColor; color: var(--accent); font-size: .85rem; vertical-align: middle; margin-left: .6rem; }
.facts { display: grid; grid-template-columns: repeat(auto-fit, minmax(150px, 1fr)); gap: .75rem; margin: 1.25rem 0; }
.facts div { background: var(--card); border: 1px solid var(--line); border-radius: 10px; padding: .7rem .9rem; }
.facts b { display: block; font-size: 1.2rem; }
.facts span { color: var(--muted); font-size: .85rem; }
figure { margin: 1rem 0; background: #ffffff; border: 1px solid var(--line); border-radius: 10px; overflow: hidden; }
figure img { display: block; width: 100%; height: auto; }
table { border-collapse: collapse; width: 100%; font-size: .92rem; }
td, th { text-align: left; }
td { border-bottom: 1px solid var(--line); padding: .3rem .6rem .3rem 0; overflow-wrap: anywhere; }
td:first-child { color: var(--muted); width: 40%; }
pre { background: var(--card); border: 1px solid var(--line); border-radius: 10px; padding: 1rem; overflow-x: auto; font-size: .85rem; line-height: 1.45; }
"""

TITLES = {"final.png": "Last state", "moments.png": "Four moments", "probes.png": "Probes", "energies.png": "Energies", "solver.png": "Solver", "compare.png": "Runs beside each other",
          "verification.png": "Explicit against implicit", "sweep.png": "Speed against error"}

TAIL = "</main>\n</body>\n</html>\n"


def flatten(value, prefix=""):
    """rows (dotted key, text) of a nested summary"""
    for key, item in value.items():
        if isinstance(item, dict):
            yield from flatten(item, f"{prefix}{key}.")
        else:
            yield prefix + key, f"{item:.6g}" if isinstance(item, float) else "-" if item is None else str(item)


def facts(run):
    """what one looks for first"""
    summary, result = run.summary, []
    fluid = summary.get("fluid") if isinstance(summary.get("fluid"), dict) else {}
    for name, value, form in (
        ("particles", fluid.get("particles"), "{:,}"), ("steps", summary.get("steps"), "{:,}"), ("simulated", summary.get("time_end"), "{:.4g} s"),
        ("wall time", summary.get("wall_seconds"), "{:.4g} s"), ("iterations a step", fluid.get("iterations_mean"), "{:.3g}"),
        ("mean density error", fluid.get("density_error_mean"), "{:.2%}"), ("threads", summary.get("threads"), "{}"), ("backend", summary.get("backend"), "{}")):
        if value is None:
            continue
        try:
            result.append((name, form.format(value)))
        except (ValueError, TypeError):
            result.append((name, str(value)))
    return result


def figure(path):
    with open(path, "rb") as file:
        data = base64.b64encode(file.read()).decode()
    name = os.path.basename(path)
    title = TITLES.get(name) or "Probe " + html.escape(name[len("profile_"):-len(".png")])
    return f'<h2>{title}</h2>\n<figure><img alt="{title}" src="data:image/png;base64,{data}"></figure>\n'


def head(title):
    return ("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
            f"<meta name=\"color-scheme\" content=\"light dark\">\n<title>{html.escape(title)}</title>\n<style>{CSS}</style>\n</head>\n<body>\n<main>\n")


def write(parts, path):
    def body(name):
        with open(name, "w", encoding="utf-8") as file:
            file.write("".join(parts))

    style.write(path, body)


def write_page(run, pictures, path):
    summary = run.summary
    status = f'<span class="status">{html.escape(str(summary["status"]))}</span>' if "status" in summary else ""
    parts = [
        head(run.name),
        f"<h1>{html.escape(run.name)}{status}</h1>\n<p class=\"lead\">{html.escape(os.path.abspath(run.directory))}</p>\n",
        '<div class="facts">' + "".join(f"<div><b>{html.escape(v)}</b><span>{html.escape(n)}</span></div>" for n, v in facts(run)) + "</div>\n",
    ]
    parts += [figure(p) for p in pictures]
    if summary:
        rows = "".join(f"<tr><td>{html.escape(k)}</td><td>{html.escape(v)}</td></tr>\n" for k, v in flatten(summary))
        parts.append(f"<h2>Summary</h2>\n<table>\n{rows}</table>\n")
    if run.scene_text:
        parts.append(f"<h2>Scene</h2>\n<pre>{html.escape(run.scene_text)}</pre>\n")
    parts.append(TAIL)
    write(parts, path)
