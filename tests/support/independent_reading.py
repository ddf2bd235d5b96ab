#!/usr/bin/python3
"""Reads currents with netCDF4 for Python and interpolates them with its own arithmetic: what tests hold our reading against.

    independent_reading.py POINTS SEED EAST NORTH FILE...

Several files are joined by their times. Random points, uniform over the cells of all axes (the seam of a global grid
included), whose corners all have values. Two files are written: POINTS, a CSV of lat,lon,time,depth for `glidehelm field
sample --points`, and on standard output, a line for each point, east, north and the largest difference of the corners.
Values whose primary quality flag is 4 (fail) do not count.
"""
import datetime
import random
import sys

import netCDF4
import numpy as np

points, seed, east, north, paths = sys.argv[1], int(sys.argv[2]), sys.argv[3], sys.argv[4], sys.argv[5:]
EPOCH = datetime.datetime(1970, 1, 1)
KINDS = (("t", "time"), ("y", "lat"), ("x", "lon"))


def kind_of(dimension):
    return next((kind for kind, word in KINDS if word in dimension.lower()), "z")


def seconds(variable):
    unit = variable.units if "units" in variable.ncattrs() else variable.getncattr("Unit")
    dates = netCDF4.num2date(variable[:].tolist(), unit, only_use_cftime_datetimes=False,
                             only_use_python_datetimes=True)
    return np.array([round((d - EPOCH).total_seconds(), 3) for d in np.atleast_1d(dates)])


def numbers(variable):
    """Values without what is missing. By hand: netCDF4 would also mask by valid_range, as it does the second date of GLORYS."""
    raw = np.array(variable[:])
    missing = np.isnan(raw.astype(float))
    for name in ("_FillValue", "missing_value"):
        if name in variable.ncattrs():
            missing |= raw == variable.getncattr(name)
    scale = variable.scale_factor if "scale_factor" in variable.ncattrs() else 1
    offset = variable.add_offset if "add_offset" in variable.ncattrs() else 0
    return np.where(missing, np.nan, raw.astype(float) * float(scale) + float(offset))


def read(path):
    data = netCDF4.Dataset(path)
    data.set_auto_maskandscale(False)
    axes = {kind_of(name): (seconds(data[name]) if kind_of(name) == "t" else np.array(data[name][:], dtype=float))
            for name in data[east].dimensions}
    values = []
    for name in (east, north):
        array = numbers(data[name])
        if "qc_primary_flag" in data.variables:
            array[data["qc_primary_flag"][:] == 4] = np.nan
        values.append(array)
    return axes, values


axes, (u, v) = read(paths[0])
for path in paths[1:]:
    more, (mu, mv) = read(path)
    axes["t"] = np.concatenate([axes["t"], more["t"]])
    u, v = np.concatenate([u, mu]), np.concatenate([v, mv])
order = list(axes)
x = axes["x"]
around = 360 - abs(x[-1] - x[0]) <= 1.001 * np.abs(np.diff(x)).max()

dice = random.Random(seed)
rows = []
while len(rows) < 1000:
    place, cells = {}, []
    for kind in order:
        axis = axes[kind]
        if len(axis) == 1:
            place[kind] = axis[0]
            cells.append((0, 0, 0.0))
            continue
        seam = kind == "x" and around
        i = dice.randrange(len(axis) - (0 if seam else 1))
        j = (i + 1) % len(axis)
        begin, end = axis[i], axis[j] + (360 if j == 0 else 0)
        value = begin + dice.random() * (end - begin)
        value = round(value, 3) if kind == "t" else value
        place[kind] = value
        cells.append((i, j, (value - begin) / (end - begin)))
    corners = []
    for corner in range(1 << len(order)):
        index, weight = [], 1.0
        for n, (i, j, fraction) in enumerate(cells):
            far = corner >> n & 1
            index.append(j if far else i)
            weight *= fraction if far else 1 - fraction
        corners.append((weight, u[tuple(index)], v[tuple(index)]))
    table = np.array(corners)
    if not np.isfinite(table).all():
        continue
    spread = max(np.ptp(table[:, 1]), np.ptp(table[:, 2]))
    rows.append((place, table[:, 0] @ table[:, 1], table[:, 0] @ table[:, 2], spread))

with open(points, "w") as out:
    for place, _, _, _ in rows:
        moment = EPOCH + datetime.timedelta(milliseconds=round(place["t"] * 1000))
        depth = "%.9f" % place["z"] if "z" in place and len(axes["z"]) > 1 else ""
        out.write("%.12f,%.12f,%s.%03dZ,%s\n" % (place["y"], (place["x"] + 180) % 360 - 180,
                                                 moment.strftime("%Y-%m-%dT%H:%M:%S"), moment.microsecond // 1000, depth))
for _, su, sv, spread in rows:
    print("%.12g %.12g %.6g" % (su, sv, spread))
