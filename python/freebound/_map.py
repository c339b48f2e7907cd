"""Many files, on any executor."""

from __future__ import annotations

import hashlib
import json
import os
import posixpath
import tempfile
import time
from concurrent.futures import Executor, as_completed
from dataclasses import asdict, dataclass
from typing import Any, Callable, Iterable, Iterator, Sequence

from . import _arrays, _freebound
from ._errors import Error, NotProved, OptionError

#: End of the name of a record, beside the result.
_RECORD = ".freebound.json"


@dataclass(frozen=True)
class MapRecord:
    """Result of one file. It is written beside the output, so that a second run skips the file."""

    input: str
    """Path of the mesh."""
    output: str | None
    """Path of the written mesh, or None."""
    status: str
    """"proved", "not-proved", "refused" or "failed"."""
    message: str
    """Verdict, or the reason of the failure."""
    seconds: float
    """Seconds of the run."""
    input_digest: str
    """SHA-256 of the input and the options."""
    output_digest: str | None
    """SHA-256 of the written mesh."""
    faces: int
    """Number of faces."""
    energy: float | None
    """Mean symmetric Dirichlet energy; 4 is an isometric map."""
    resumed: bool = False
    """True if the result of an earlier run was kept."""


def map(
    files: Iterable[str | os.PathLike[str]],
    output_dir: str | os.PathLike[str],
    *,
    executor: Executor | None = None,
    unwrap: bool = True,
    suffix: str | None = None,
    resume: bool = True,
    progress: Callable[[MapRecord], None] | None = None,
    **options: Any,
) -> Iterator[MapRecord]:
    """Unwraps or flattens many files, and yields a record for each as it ends.

    >>> from concurrent.futures import ProcessPoolExecutor
    >>> with ProcessPoolExecutor() as pool:
    ...     for record in freebound.map(paths, "out", executor=pool, threads=1):
    ...         print(record.input, record.status)

    A file that fails stops nothing. Each result is written whole or not at all, with a record beside it. A second run
    keeps results whose input, options, version and bytes are unchanged; glTF files with files of their own (.gltf) are run
    again. Results with equal names get numbers.

    Args:
        files: paths of meshes, or URLs that ``fsspec`` opens.
        output_dir: folder or URL of the results.
        executor: any ``concurrent.futures`` executor, or a client of ``dask.distributed``. Default: one after the other
            in this process.
        unwrap: True for :func:`unwrap`, False for :func:`flatten`.
        suffix: extension of the results, such as ".glb". Default: that of the input.
        resume: False to run all files again.
        progress: function that receives each record.
        options: options of :func:`flatten`.

    Raises:
        OptionError: an option is wrong, or a result would replace one of the files.
    """
    paths = [os.fspath(path) for path in files]
    outputs = _outputs(paths, os.fspath(output_dir), suffix)
    # Wrong options fail at once, not in every file.
    text, lists = _arrays.request({"unwrap": unwrap, **options})
    _freebound.check_options(text, lists)
    key = hashlib.sha256(f"{_freebound.VERSION} {text}".encode())
    for name in sorted(lists):
        key.update(name.encode())
        key.update(b"" if lists[name] is None else lists[name].tobytes())
    tasks = [(path, output, unwrap, options, key.hexdigest(), resume) for path, output in zip(paths, outputs)]
    return _told(_records(tasks, executor), progress)


def _told(records: Iterator[MapRecord], progress: Callable[[MapRecord], None] | None) -> Iterator[MapRecord]:
    for record in records:
        if progress:
            progress(record)
        yield record


def _records(tasks: Sequence[tuple[Any, ...]], executor: Any) -> Iterator[MapRecord]:
    if executor is None:
        yield from (_one(*task) for task in tasks)
        return
    if hasattr(executor, "get_executor"):
        # A client of dask.distributed.
        executor = executor.get_executor(pure=False)
    futures = [executor.submit(_one, *task) for task in tasks]
    waiting = dict(zip(futures, tasks))
    try:
        for future in as_completed(futures):
            try:
                yield future.result()
            except Exception as error:  # noqa: BLE001 - a worker died, or the executor failed
                yield _failed(waiting[future], f"{type(error).__name__}: {error}")
    finally:
        for future in futures:
            future.cancel()


def _failed(task: tuple[Any, ...], message: str) -> MapRecord:
    return MapRecord(task[0], None, "failed", message, 0.0, "", None, 0, None)


def _outputs(paths: Sequence[str], folder: str, suffix: str | None) -> list[str]:
    """Path of the result of each file. Results with equal names get numbers."""
    writable = (".obj", ".ply", ".glb")
    inputs = {_place(path) for path in paths}
    outputs: list[str] = []
    taken: set[str] = set()
    for path in paths:
        stem, extension = posixpath.splitext(posixpath.basename(path.replace(os.sep, "/")))
        extension = suffix or (extension.lower() if extension.lower() in writable else ".obj")
        if extension not in writable:
            raise OptionError(f"suffix: choose one of {', '.join(writable)}")
        name, count = stem + extension, 1
        while name in taken:
            count += 1
            name = f"{stem}-{count}{extension}"
        taken.add(name)
        outputs.append(posixpath.join(folder, name))
        if _place(outputs[-1]) in inputs:
            raise OptionError(f"{outputs[-1]}: the result would replace a mesh: choose another folder")
    return outputs


def _place(path: str) -> str:
    return path if _is_remote(path) else os.path.realpath(path)


def _is_remote(path: str) -> bool:
    return "://" in path


def _filesystem(path: str) -> Any:
    try:
        import fsspec
    except ImportError as error:
        raise OptionError(f"{path}: URLs need fsspec: pip install freebound[remote]") from error
    return fsspec.core.url_to_fs(path)


def _read_bytes(path: str) -> bytes:
    if _is_remote(path):
        system, name = _filesystem(path)
        return system.cat_file(name)
    with open(path, "rb") as file:
        return file.read()


def _write_whole(path: str, content: bytes) -> None:
    """Writes a file aside and renames it; object stores write whole objects."""
    if _is_remote(path):
        system, name = _filesystem(path)
        system.makedirs(posixpath.dirname(name), exist_ok=True)
        system.pipe_file(name, content)
        return
    folder = os.path.dirname(path) or "."
    os.makedirs(folder, exist_ok=True)
    handle, aside = tempfile.mkstemp(dir=folder, prefix=".freebound-")
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(content)
        # A new file is as readable as others, not for its owner alone.
        mask = os.umask(0)
        os.umask(mask)
        os.chmod(aside, 0o666 & ~mask)
        os.replace(aside, path)
    except BaseException:
        os.unlink(aside)
        raise


def _remove(path: str) -> None:
    try:
        if _is_remote(path):
            system, name = _filesystem(path)
            system.rm_file(name)
        else:
            os.unlink(path)
    except FileNotFoundError:
        pass


def _kept(path: str, output: str, digest: str) -> MapRecord | None:
    """Record of an earlier run, if its input, its options and its result are unchanged."""
    if path.lower().endswith(".gltf"):
        # Its buffers are files of their own.
        return None
    try:
        record = MapRecord(**json.loads(_read_bytes(output + _RECORD)))
        if record.input_digest != digest:
            return None
        if record.output_digest is not None and hashlib.sha256(_read_bytes(output)).hexdigest() != record.output_digest:
            return None
    except (OSError, ValueError, TypeError):
        return None
    kept = {"input": path, "output": None if record.output is None else output, "resumed": True}
    return MapRecord(**{**asdict(record), **kept})


def _one(path: str, output: str, unwrap: bool, options: dict[str, Any], key: str, resume: bool) -> MapRecord:
    """Runs one file, and writes its result and its record."""
    start = time.perf_counter()
    digest = ""

    def ended(status: str, error: BaseException) -> MapRecord:
        return MapRecord(path, None, status, str(error), time.perf_counter() - start, digest, None, 0, None)

    try:
        content = _read_bytes(path)
        digest = hashlib.sha256(key.encode() + content).hexdigest()
        kept = _kept(path, output, digest) if resume else None
        if kept is not None:
            return kept
        # Neither the record nor the result of an earlier run stays beside those of this one.
        _remove(output + _RECORD)
        _remove(output)
        try:
            record = _solved(path, content, output, unwrap, options, digest, start)
        except NotProved as error:
            record = ended("not-proved", error)
        except Error as error:
            record = ended("refused", error)
        _write_whole(output + _RECORD, json.dumps(asdict(record)).encode())
        return record
    except Exception as error:  # noqa: BLE001 - a file that fails stops nothing
        return ended("failed", error)


def _solved(
    path: str, content: bytes, output: str, unwrap: bool, options: dict[str, Any], digest: str, start: float
) -> MapRecord:
    from ._mesh import Mesh
    from ._run import flatten as flatten_mesh
    from ._run import unwrap as unwrap_mesh

    with tempfile.TemporaryDirectory(prefix="freebound-") as folder:
        local = path
        if _is_remote(path):
            local = os.path.join(folder, posixpath.basename(path))
            with open(local, "wb") as file:
                file.write(content)
        layout = (unwrap_mesh if unwrap else flatten_mesh)(Mesh.read(local), **options)
        try:
            if _is_remote(output):
                # A mesh from a store lies beside the result, so that the names of its materials stay as they are.
                result = os.path.join(folder, "result" + posixpath.splitext(output)[1])
                layout.save(result)
                _write_whole(output, _read_bytes(result))
            else:
                os.makedirs(os.path.dirname(output) or ".", exist_ok=True)
                layout.save(output)
        except NotProved:
            _remove(output)
            raise
        written = _read_bytes(output)
    return MapRecord(
        input=path,
        output=output,
        status="proved",
        message=layout.verdict.summary,
        seconds=time.perf_counter() - start,
        input_digest=digest,
        output_digest=hashlib.sha256(written).hexdigest(),
        faces=len(layout.chart),
        energy=layout.energy,
    )
