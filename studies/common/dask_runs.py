"""What the jobs on Dask share: workers, the component's way to them, and results that outlive a kill.

A job is a list of keys. Each is computed by a worker and is then at once a Parquet file, whole or not there, with a
stamp of all that it depends on; what is there with the right stamp is not computed again.
"""

import argparse
import hashlib
import importlib.util
import shutil
import sys
import tempfile
import threading
import time
from contextlib import contextmanager
from functools import cache
from pathlib import Path

import pyarrow as pa
import pyarrow.parquet as pq
from dask.distributed import Client, LocalCluster, as_completed, get_worker
from helpers import FMU, REPOSITORY

# ---- on a worker ----------------------------------------------------------------------------------------------------


def local_file(component, digest):
    """The component, which came as data, as a file of this worker."""
    return own_file(f"{digest}.fmu", component)


def own_file(name, content):
    """A file that goes with this worker, or with this process where it is none."""
    try:
        folder = get_worker().local_directory
    except ValueError:
        folder = folder_of_the_process().name
    path = Path(folder) / name
    if not path.exists():
        # Another thread of this process may be doing the same.
        own = path.with_suffix(f".{threading.get_ident()}")
        own.write_bytes(content)
        own.replace(path)
    return path


@cache
def folder_of_the_process():
    """A folder that goes at the end of the process."""
    return tempfile.TemporaryDirectory()


# ---- on the client --------------------------------------------------------------------------------------------------


def read_component(fmu=FMU):
    """Return the component as data, and its digest."""
    component = fmu.read_bytes()
    return component, hashlib.sha256(component).hexdigest()


def stamp_of(*settings):
    """Return the stamp of a result that depends on these."""
    text = " ".join(str(value) for value in settings)
    return hashlib.sha256(text.encode()).hexdigest().encode()


def is_done(path, stamp):
    """Whether a result is there and depends on the same."""
    return path.exists() and pq.read_schema(path).metadata.get(b"stamp") == stamp


def write_table(path, stamp, columns, notes=None):
    """Write columns, each (unit or None for text, values), and notes by name; the file is there whole or not at all."""
    fields, arrays = [], []
    for name, (unit, values) in columns.items():
        kind = pa.string() if unit is None else pa.float64()
        fields.append(pa.field(name, kind, metadata=None if unit is None else {"unit": unit}))
        arrays.append(pa.array(values, kind))
    unfinished = path.with_suffix(".unfinished")
    schema = pa.schema(fields, metadata={"stamp": stamp} | (notes or {}))
    pq.write_table(pa.Table.from_arrays(arrays, schema=schema), unfinished)
    unfinished.replace(path)


def missing(keys, path_of, stamp_of_key, noun):
    """Return those of the keys whose results are not there yet."""
    left = [key for key in keys if not is_done(path_of(*key), stamp_of_key(*key))]
    if len(left) < len(keys):
        print(f"  {len(keys) - len(left)} of {len(keys)} {noun} are there from before", flush=True)
    return left


def computed(client, function, keys, component, arguments, noun, quiet=False):
    """Compute function(component, *arguments(key)) on the workers; yield (key, result) as each is finished."""
    if not keys:
        return
    data = client.scatter(component, broadcast=True)
    futures = {client.submit(function, data, *arguments(*key), pure=False): key for key in keys}
    began = time.perf_counter()
    for number, future in enumerate(as_completed(futures), 1):
        yield futures[future], future.result()
        if not quiet:
            report(number, len(keys), time.perf_counter() - began, noun)


def report(number, count, seconds, noun):
    """A line of progress: in place on a terminal, every tenth in a log."""
    if sys.stdout.isatty() or number * 10 // count > (number - 1) * 10 // count:
        left = seconds / number * (count - number)
        end = "\r" if sys.stdout.isatty() and number < count else "\n"
        print(f"  {number} of {count} {noun}, {number / seconds:.1f} a second, {left:.0f} s left ", end=end, flush=True)


# ---- workers --------------------------------------------------------------------------------------------------------


@contextmanager
def local_client(workers):
    """Processes of one thread each on this machine."""
    with (
        LocalCluster(n_workers=workers, threads_per_worker=1, dashboard_address="127.0.0.1:0") as cluster,
        Client(cluster) as client,
    ):
        yield client


@contextmanager
def client_for(scheduler, workers, modules):
    """Workers of an existing cluster, with these modules and those below them sent there, or on this machine."""
    if scheduler is None:
        with local_client(workers) as client:
            yield client
        return
    try:
        client = Client(scheduler)
    except (OSError, ValueError) as error:
        sys.exit(f"--scheduler {scheduler}: {error}")
    with client:
        # Workers on this machine find it where this process does.
        with tempfile.TemporaryDirectory() as folder:
            client.upload_file(shutil.make_archive(f"{folder}/package", "zip", REPOSITORY / "python", "wheelrail"))
        for name in ("helpers", "dask_runs", *modules):
            client.upload_file(importlib.util.find_spec(name).origin)
        yield client


def number_of_workers(text):
    """A number of workers, at least one: without any a job would wait for them."""
    if (number := int(text)) < 1:
        raise argparse.ArgumentTypeError(f"{number}: at least 1")
    return number


def add_options(parser, noun):
    """Options that every job has."""
    parser.add_argument("--scheduler", help="address of a Dask scheduler; without one, workers on this machine")
    parser.add_argument("--workers", type=number_of_workers, default=2, help="workers on this machine (2)")
    parser.add_argument("--fresh", action="store_true", help=f"forget the {noun} that are there from before")
