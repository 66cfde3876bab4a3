"""The HTML page of a command that measures: results with the names and units that people read."""
import pathlib
import shlex
import sys

from dspace.command_line import lazy

np = lazy("numpy")

# Units by the endings of names, and the decimals that their measurements have.
UNITS = {"_deg": ("deg", 6), "_m": ("m", 4), "_s": ("s", 3), "_m2": ("m²", 6), "_w": ("W", 4), "_wh": ("Wh", 4),
         "_percent": ("%", 4), "_au": ("au", 9), "_utc": ("UTC", None), "_h": ("h", 4)}
FAR = 1e7  # [m]; beyond it in km


def write_page(out, found, rows, figure):
    """Writes the page. found: the result, as for JSON; rows: those of its main table; figure: or None."""
    import dspace
    page = dspace.Report(f"dspace {sys.argv[1] if len(sys.argv) > 1 else 'measurement'}")
    section = page.section("Result")
    section.values({name: values[0] for name, values in columns_of([{name: value for name, value in found.items()
                                                                     if not isinstance(value, (list, dict))}])})
    if figure is not None:
        section.figure(figure)
    tables = [("", rows)] + [(name, more) for name, more in found.items()
                             if isinstance(more, list) and more and isinstance(more[0], dict) and more is not rows]
    for name, table in tables:
        if name:
            section = page.section(name.replace("_", " ").capitalize())
        columns = columns_of(table)
        section.table([dict(zip((head for head, _ in columns), row)) for row in zip(*(values for _, values in columns))])
    given = {"command": shlex.join(["dspace", *sys.argv[1:]])}
    if found.get("terrain") and pathlib.Path(found["terrain"]).is_file():
        given["terrain"] = pathlib.Path(found["terrain"])
    page.inputs(**given)
    page.write(out)


def columns_of(rows):
    """Returns [(name, values)] for a table of dicts with the same keys. The name "from_lon_deg" becomes "from lon [deg]". Values are
    rounded by their unit. Columns without any value are left out."""
    columns = []
    for name in rows[0] if rows else ():
        values = [row[name] for row in rows]
        values = [value.item() if isinstance(value, np.generic) else value for value in values]
        if all(value is None for value in values):
            continue
        ending = max((each for each in UNITS if name.endswith(each)), key=len, default=None)
        if ending is None:
            columns.append((name.replace("_", " "), values))
            continue
        unit, decimals = UNITS[ending]
        numbers = [value for value in values if isinstance(value, float) and np.isfinite(value)]
        if unit == "m" and max(map(abs, numbers), default=0.0) > FAR:
            unit, values = "km", [value / 1000.0 if isinstance(value, float) else value for value in values]
        # -0.0 is 0.
        values = [round(value, decimals) + 0.0 if decimals and isinstance(value, float) else value for value in values]
        columns.append((f"{name[:-len(ending)].replace('_', ' ')} [{unit}]".strip(), values))
    return columns
