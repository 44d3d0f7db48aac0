"""What the lines of maintenance.py say: spread, shares, trains up to a limit, tables and the picture."""

import matplotlib.pyplot as plt
import numpy as np
from braking_line import AS_IT_IS, FACTORS, SCENARIOS, TRAINS, WEATHER
from helpers import BLACK, BLUE, GREEN, ORANGE, RED, SKY, markdown_table, save, write_tables
from scipy.special import chdtri, ndtri

BASE = next(name for name, settings in SCENARIOS.items() if settings == AS_IT_IS)
ALONE = next(name for name, settings in SCENARIOS.items() if settings["weather"] == 0.0)
LIMIT = 0.3e-3  # m, an example of a limit
HERMITE = 60  # polynomials for the wear over the weather
MICROMETRE = 1e-6
COLOURS = dict(zip(SCENARIOS, (BLACK, GREEN, BLUE, ORANGE, RED, SKY), strict=True))


# ---- statistics -----------------------------------------------------------------------------------------------------


def band(values, axis=0):
    """5th percentile, median, 95th percentile."""
    return np.quantile(values, (0.05, 0.5, 0.95), axis=axis)


def hermite(share, wear, count=HERMITE):
    """Covariance of the wear of a train with the normalised Hermite polynomials of its weather, from the first on."""
    normal, wear = ndtri(share.ravel()), wear.ravel() - wear.mean()
    before, now, found = np.ones_like(normal), normal, []
    for degree in range(1, count + 1):
        found.append(np.mean(wear * now))
        before, now = now, (normal * now - np.sqrt(degree) * before) / np.sqrt(degree + 1.0)
    return np.array(found)


def line_variance(share, wear, memory, trains):
    """Variance of the wear after a line of trains, from trains that are drawn one by one.

    n sigma^2 + 2 sum_k c_k^2 sum_h (n - h) exp(-k h/memory): the weather is normal with the correlation exp(-h/memory)
    over h trains, its k-th Hermite polynomial has the k-th power of that (Mehler), and c_k is the wear's covariance
    with it. Without memory it is n sigma^2.
    """
    alone = trains * wear.var()
    if memory == 0.0:
        return alone
    lags = np.arange(1, trains)
    squares = hermite(share, wear) ** 2
    # What chance makes of a coefficient that is zero.
    squares -= wear.var() / wear.size
    powers = np.exp(-np.outer(np.arange(1, len(squares) + 1), lags) / memory)
    return alone + 2.0 * float(squares @ powers @ (trains - lags))


def shares(lines):
    """Share of each factor in the variance of a train's wear, and in that of a line's: what fixing it would take away.

    Then the standard error of the former, over lines.

    Of a train: E (w - w')^2 / (2 var w) with that factor drawn again (Jansen's total index); they add up to more than 1
    where factors work together. Of a line: all but the weather are drawn train by train, and add n times their part.
    """
    alone = lines[ALONE, ""]
    train, error = {}, {}
    for factor in FACTORS:
        again = lines[ALONE, factor]["wear_depth"]
        first = alone["wear_depth"][: len(again)]
        both = np.concatenate([again.ravel(), first.ravel()])
        each = np.mean((again - first) ** 2, axis=1) / (2.0 * both.var())
        train[factor], error[factor] = float(each.mean()), float(each.std(ddof=1) / np.sqrt(len(each)))
    trains = alone["wear_depth"].shape[1]
    variance = alone["wear_depth"].var()
    whole = line_variance(alone["share"], alone["wear_depth"], WEATHER, trains)
    line = {factor: share * trains * variance / whole for factor, share in train.items()}
    line["friction"] = 1.0 - (1.0 - train["friction"]) * trains * variance / whole
    return train, line, error


def trains_to_limit(depths, trains, limit=LIMIT):
    """Trains up to a depth: 5th percentile, median, 95th, if lines go on as they began.

    Depth after n trains: normal with the mean n m and the variance n v, m and v from lines of many correlations.
    """
    mean, variance = depths.mean() / trains, depths.var(ddof=1) / trains
    # n m + q sqrt(n v) = limit, in sqrt(n).
    roots = [
        (-q * np.sqrt(variance) + np.sqrt(q * q * variance + 4.0 * mean * limit)) / (2.0 * mean)
        for q in ndtri([0.95, 0.5, 0.05])
    ]
    return np.square(roots)


# ---- tables ---------------------------------------------------------------------------------------------------------


def depths(lines, scenario, name="wear_depth"):
    """Depth after each line [um]."""
    return lines[scenario, ""][name].sum(axis=1) / MICROMETRE


def change(lines, scenario):
    """Change of the mean against the same lines as they are, and its standard error over lines; none for itself."""
    if scenario in (BASE, ALONE):
        return ""
    now, before = depths(lines, scenario), depths(lines, BASE)
    ratio = now.mean() / before.mean()
    error = (now - ratio * before).std(ddof=1) / np.sqrt(len(now)) / before.mean()
    return f"{100.0 * (ratio - 1.0):+.0f} ± {100.0 * error:.0f} %"


def tables(lines):
    """Write the tables of the page."""
    rows = []
    for name in SCENARIOS:
        found = lines[name, ""]
        count = len(found["wear_depth"])
        low, middle, high = band(depths(lines, name))
        early, usual, late = trains_to_limit(depths(lines, name) * MICROMETRE, TRAINS)
        rows.append(
            [
                name,
                f"{count}",
                f"{100.0 * found['sliding_wheels'].mean() / 8.0:.2f} %",
                f"{depths(lines, name).mean():.1f} ± {depths(lines, name).std(ddof=1) / np.sqrt(count):.1f}",
                change(lines, name),
                f"{low:.1f} – {middle:.1f} – {high:.1f}",
                f"{early:.0f} – {usual:.0f} – {late:.0f}",
                f"{depths(lines, name, 'wear_depth_energy').mean():.1f}",
            ]
        )
    head = ["", "lines", "wheels that slide", "mean µm", "against the same lines", "5 % – median – 95 %, µm"]
    head += [f"trains to {LIMIT * 1e3:g} mm: 5 % – median – 95 %", "mean by friction energy, µm"]
    train, line, error = shares(lines)
    parts = [
        [factor, f"{100 * train[factor]:.1f} ± {100 * error[factor]:.1f} %", f"{100 * line[factor]:.1f} %"]
        for factor in FACTORS
    ]
    write_tables(
        "maintenance.md",
        {
            "scenarios": markdown_table(head, rows),
            "shares": markdown_table(["drawn at random", "share in one train", f"in a line of {TRAINS}"], parts),
            "spread": markdown_table(["", "by formula, µm", "lines, µm", "95 % interval of the latter"], spread(lines)),
            "passages": markdown_table(["", ""], passages(lines)),
        },
    )


def spread(lines):
    """Standard deviation over lines: by formula from single trains, and as found."""
    alone = lines[ALONE, ""]
    rows = []
    for name, memory in ((ALONE, 0.0), (BASE, WEATHER)):
        found = depths(lines, name)
        free = len(found) - 1
        formula = np.sqrt(line_variance(alone["share"], alone["wear_depth"], memory, TRAINS)) / MICROMETRE
        low, high = found.std(ddof=1) * np.sqrt(free / chdtri(free, [0.025, 0.975]))
        rows.append([name, f"{formula:.1f}", f"{found.std(ddof=1):.1f}", f"{low:.1f} – {high:.1f}"])
    return rows


def passages(lines):
    """What was computed, and what a sliding train does."""
    base = lines[BASE, ""]
    count = sum(found["wear_depth"].size for found in lines.values())
    solves = sum(found["solves"].sum() for found in lines.values())
    slides = base["sliding_wheels"] > 0.0
    each = base["wear_depth"] / MICROMETRE
    return [
        ["trains, wheels", f"{count}, {8 * count}"],
        ["solutions of the contact for a wheel", f"{solves / (8 * count):.2f}"],
        [f"wear by a train that does not slide, {BASE}", f"{1e3 * each[~slides].mean():.1f} nm"],
        [f"wear by one that does, {BASE}", f"{each[slides].mean():.2f} µm"],
        ["hottest rail surface", f"{base['peak_temperature'].max() - 273.15:.0f} °C"],
        ["largest rise that a wheel finds from those before it", f"{base['incoming_rise'].max():.1f} K"],
    ]


# ---- the picture ----------------------------------------------------------------------------------------------------


def draw(lines):
    """Depth over trains; after all of them by scenario; which chance matters; which wear law."""
    figure, panels = plt.subplots(2, 2, figsize=(12.0, 8.0), layout="constrained", width_ratios=(1.1, 1.0))
    draw_growth(panels[0, 0], lines)
    draw_scenarios(panels[0, 1], lines)
    draw_shares(panels[1, 0], lines)
    draw_laws(panels[1, 1], lines)
    for axes in panels.flat:
        axes.set_axisbelow(True)
    save(figure, "maintenance.png")


def draw_growth(axes, lines):
    """Each line as it is thin, its band, and that of the cleaned rail."""
    best = next(name for name, settings in SCENARIOS.items() if settings["contaminated"] > 1.0)
    trains = np.arange(1, TRAINS + 1)
    for name in (BASE, best):
        grown = np.cumsum(lines[name, ""]["wear_depth"], axis=1) / MICROMETRE
        low, middle, high = band(grown)
        axes.fill_between(trains, low, high, color=COLOURS[name], alpha=0.15, linewidth=0)
        if name == BASE:
            axes.plot(trains, grown[:12].T, color=COLOURS[name], linewidth=0.5, alpha=0.6)
        axes.plot(trains, middle, color=COLOURS[name], linewidth=2.5)
        axes.annotate(name, (TRAINS, middle[-1]), (5, 0), textcoords="offset points", va="center", color=COLOURS[name])
    axes.set(xlim=(0, TRAINS), ylim=(0, None), xlabel="trains", ylabel="depth of wear [µm]")
    axes.set_title(
        "Wear comes in steps, on slippery days\nbold: median of the lines; shade: 5 to 95 %; thin: single lines"
    )


def draw_scenarios(axes, lines):
    """Each line as a dot, percentiles as bars."""
    names = list(SCENARIOS)
    for row, name in enumerate(names):
        found = depths(lines, name)
        low, middle, high = band(found)
        offsets = np.linspace(-0.16, 0.16, len(found))
        axes.plot(found, row + offsets, ".", color=COLOURS[name], markersize=4, alpha=0.6)
        axes.plot([low, high], [row, row], color=COLOURS[name], linewidth=2)
        axes.plot(middle, row, "|", color=COLOURS[name], markersize=18, markeredgewidth=3)
    axes.set_yticks(range(len(names)), names)
    axes.invert_yaxis()
    axes.set(xlim=(0, None), xlabel=f"depth of wear after {TRAINS} trains [µm]")
    axes.set_title("What would change it\ndot: a line; bar: 5 to 95 %; tick: median")


def draw_shares(axes, lines):
    """Shares of variance, of a train and of a line."""
    for offset, found, colour, label in zip(
        (-0.2, 0.2), shares(lines)[:2], (SKY, BLUE), ("of one train", f"of a line of {TRAINS} trains"), strict=True
    ):
        places = np.arange(len(FACTORS)) + offset
        values = [100.0 * found[factor] for factor in FACTORS]
        axes.barh(places, values, 0.38, color=colour, label=label)
        for place, value in zip(places, values, strict=True):
            axes.annotate(
                f"{value:.0f}" if value >= 1 else "< 1", (value, place), (3, 0), textcoords="offset points", va="center"
            )
    axes.set_yticks(range(len(FACTORS)), FACTORS)
    axes.invert_yaxis()
    axes.set(xlim=(0, 115), xlabel="share of the variance that goes if it is fixed [%]")
    axes.set_title("Which chance matters")
    axes.legend(loc="lower right")


def draw_laws(axes, lines):
    """Mean depth by wheels that creep and wheels that slide, by two laws of wear."""
    laws = {
        "sliding distance\n(Archard, component)": "wear_depth",
        "friction energy\n(twin disc, dry)": "wear_depth_energy",
    }
    for row, name in enumerate(laws.values()):
        whole, slid = (depths(lines, BASE, column).mean() for column in (name, f"{name}_sliding"))
        for start, value, colour, label in ((0.0, whole - slid, GREEN, "creep"), (whole - slid, slid, RED, "slide")):
            axes.barh(row, value, 0.5, start, color=colour, label=f"wheels that {label}" if row == 0 else None)
        axes.annotate(
            f"{whole:.1f} µm, {100 * slid / whole:.0f} % by sliding",
            (whole, row),
            (4, 0),
            textcoords="offset points",
            va="center",
        )
    axes.set_yticks(range(len(laws)), laws)
    axes.invert_yaxis()
    axes.margins(x=0.5)
    axes.set(xlabel=f"mean depth after {TRAINS} trains, as it is [µm]", title="What the law of wear makes of it")
    axes.legend(loc="lower right")
