#!/usr/bin/python3
"""A small DAP2 server on the loopback: what tests read currents from.

It serves one data set, /sea, with axes time, lat, lon and currents u, v, in the words of the DAP2 specification: .dds, .das
and .dods with constraints such as ?u[0:1:1][0:1:2][0:1:3]. The first line on standard output is the port. MODE is one of

  good       answers
  silent     accepts connections and says nothing
  cut        ends the currents half way, as long as its own Content-Length
  short      promises the whole of the currents and closes half way
  growing    has one time more at every look at its .dds
  written    has other values at every look
  zeros      has a last time of nothing but zeros
  missing    knows no such data set
  huge       describes 1.2e8 nodes
"""
import http.server
import re
import struct
import sys
import time
import urllib.parse

MODE = sys.argv[1]
TIMES, LATS, LONS = (3000, 200, 200) if MODE == "huge" else (3, 4, 5)
LOOKS = {"dds": 0, "dods": 0}


def times():
    return TIMES + (LOOKS["dds"] if MODE == "growing" else 0)


def value(name, t, j, i):
    """u grows to the east and in time, v to the north; the node in the south-west is land."""
    if j == 0 and i == 0:
        return -999.0
    if MODE == "zeros" and t == TIMES - 1:
        return 0.0
    base = 0.1 * i + 0.01 * t if name == "u" else -0.1 * j - 0.01 * t  # tests know this formula
    return base + (0.001 * LOOKS["dods"] if MODE == "written" else 0.0)


AXES = {"time": lambda k: 6.0 * k, "lat": lambda k: 40.0 + 0.25 * k, "lon": lambda k: 350.0 + 0.25 * k}


def length(axis):
    return {"time": times(), "lat": LATS, "lon": LONS}[axis]


def shape(name):
    return [name] if name in AXES else ["time", "lat", "lon"]


def asked(query):
    """The variables that a constraint asks for, with the indices of each dimension."""
    wanted = [part for part in urllib.parse.unquote(query).split(",") if part] or ["time", "lat", "lon", "u", "v"]
    answer = []
    for part in wanted:
        name = re.match(r"[\w.]+", part).group(0).split(".")[-1]
        slices = re.findall(r"\[([\d:]+)\]", part)
        indices = []
        for k, axis in enumerate(shape(name)):
            numbers = [int(n) for n in slices[k].split(":")] if k < len(slices) else [0, 1, length(axis) - 1]
            first, step, last = (numbers * 3 if len(numbers) == 1 else
                                 [numbers[0], 1, numbers[1]] if len(numbers) == 2 else numbers)
            indices.append(range(first, last + 1, step if len(numbers) == 3 else 1))
        answer.append((name, indices))
    return answer


def declaration(name, counts):
    kind = "Float64" if name in AXES else "Float32"
    return "    %s %s%s;\n" % (kind, name, "".join("[%s = %d]" % pair for pair in zip(shape(name), counts)))


def dds(query):
    return "Dataset {\n" + "".join(declaration(name, [len(r) for r in indices]) for name, indices in asked(query)) + "} sea;\n"


DAS = """Attributes {
    time { String units "hours since 2024-01-01 00:00:00"; }
    lat { String units "degrees_north"; }
    lon { String units "degrees_east"; }
    u { String units "m/s"; Float32 _FillValue -999.0; }
    v { String units "m/s"; Float32 _FillValue -999.0; }
    NC_GLOBAL { String title "A sea for tests"; }
}
"""


def dods(query):
    body = dds(query).encode() + b"Data:\n"
    for name, indices in asked(query):
        count = 1
        for r in indices:
            count *= len(r)
        body += struct.pack(">II", count, count)
        if name in AXES:
            body += b"".join(struct.pack(">d", AXES[name](k)) for k in indices[0])
        else:
            body += b"".join(struct.pack(">f", value(name, t, j, i))
                             for t in indices[0] for j in indices[1] for i in indices[2])
    return body


class Sea(http.server.BaseHTTPRequestHandler):
    def do_GET(self):
        if MODE == "silent":
            time.sleep(600)
            return
        address = urllib.parse.urlsplit(self.path)
        name, _, kind = address.path.lstrip("/").partition(".")
        if MODE == "missing" or name != "sea" or kind not in ("dds", "das", "dods"):
            self.send_error(404)
            return
        if kind in LOOKS:
            LOOKS[kind] += 1
        body = DAS.encode() if kind == "das" else dds(address.query).encode() if kind == "dds" else dods(address.query)
        promised = len(body)
        if kind == "dods" and MODE in ("cut", "short") and re.search(r"(^|[,.])[uv]\b", address.query):
            body = body[:len(body) // 2]
            promised = len(body) if MODE == "cut" else promised
        self.send_response(200)
        self.send_header("Content-Type", "application/octet-stream" if kind == "dods" else "text/plain")
        self.send_header("Content-Description", "dods_data" if kind == "dods" else "dods_" + kind)
        self.send_header("XDODS-Server", "dods/3.7")
        self.send_header("Content-Length", str(promised))
        self.end_headers()
        self.wfile.write(body)

    def log_message(self, *arguments):
        pass


server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Sea)
server.daemon_threads = True
print(server.server_address[1], flush=True)
server.serve_forever()
