"""The scratch folder that hostile commands run in, and what must still be there afterwards."""
import hashlib
import os
import shutil
import socket
import stat
import tempfile
import threading
from pathlib import Path

SCENE = '{"seed": 1, "size": "16x9", "settings": {"view.distance": 48, "world.islands": 0}}'
ROWS = ("rows", "pictures")  # folders that a part of a run writes into
NODES = {"full": (stat.S_IFCHR, 1, 7), "null": (stat.S_IFCHR, 1, 3), "zero": (stat.S_IFCHR, 1, 5), "disk": (stat.S_IFBLK, 7, 200)}


def snapshot(folder):
    """Names with type, device, target of a link and content of a file."""
    found = {}
    for path in sorted(Path(folder).rglob("*")):
        info = path.lstat()
        kind = stat.S_IFMT(info.st_mode)
        what = [kind, info.st_rdev if kind in (stat.S_IFCHR, stat.S_IFBLK) else 0]
        if stat.S_ISLNK(info.st_mode):
            what.append(os.readlink(path))
        if stat.S_ISREG(info.st_mode):
            what.append(hashlib.sha256(path.read_bytes()).hexdigest())
        found[str(path.relative_to(folder))] = tuple(what)
    return found


class Scratch:
    """One folder with everything that an option may stumble over; gone at the end of the with statement."""

    def __init__(self, worlds, wild_json):
        self.folder = Path(tempfile.mkdtemp(prefix="skerry_hostile_"))
        self.home = Path(tempfile.mkdtemp(prefix="skerry_hostile_home_"))
        self.stop = threading.Event()
        self.threads = []
        self.sockets = []
        for name, data in worlds.items():
            (self.folder / name).parent.mkdir(parents=True, exist_ok=True)
            (self.folder / name).write_bytes(data)
        self._files(wild_json)
        self._links()
        self._nodes()
        self._sockets()
        self.before = snapshot(self.folder)
        self._run(self._drain)
        self._run(self._feed)
        self._run(self._accept)

    def _files(self, wild_json):
        folder = self.folder
        (folder / "keep.txt").write_text("a stranger's words\n")
        (folder / "keep.png").write_bytes(b"\x89PNG a stranger's picture")
        (folder / "read_only.txt").write_text("look, do not touch\n")
        (folder / "read_only.txt").chmod(0o444)
        (folder / "new\nline").write_text("x")
        (folder / "ünïcödé").write_text("x")
        (folder / "scene.json").write_text(SCENE)
        (folder / "wild.json").write_text(wild_json, errors="surrogatepass")
        (folder / "rows.json").write_text('{"rows": [{}], "shard": "1/1"}')
        (folder / "dir").mkdir()
        (folder / "dir/inside.txt").write_text("inside\n")
        (folder / "dir/index.html").write_text("my page\n")
        (folder / "report").mkdir()
        (folder / "report/report.json").write_text("{}\n")
        (folder / "scenes").mkdir()
        (folder / "scenes/one.json").write_text(SCENE)
        os.link(folder / "keep.txt", folder / "hard_link")

    def _links(self):
        for name, target in {"link": "keep.txt", "link_to_link": "link", "dangling": "made_by_link", "dangling_far": "no/such/target",
                             "loop": "loop", "link_to_dir": "dir", "link_to_full": "full", "link_to_fifo": "fifo"}.items():
            (self.folder / name).symlink_to(target)

    def _nodes(self):
        for name in ("fifo", "fifo_read", "fifo_fed"):
            os.mkfifo(self.folder / name)
        if os.geteuid() == 0:
            for name, (kind, major, minor) in NODES.items():
                try:
                    os.mknod(self.folder / name, kind | 0o600, os.makedev(major, minor))
                except PermissionError:  # a container's root may not
                    return

    def _sockets(self):
        for name in ("socket", "socket_deaf"):
            one = socket.socket(socket.AF_UNIX)
            one.bind(str(self.folder / name))
            self.sockets.append(one)
        self.sockets[0].listen()
        self.sockets[0].settimeout(0.05)

    def _run(self, work):
        thread = threading.Thread(target=work, daemon=True)
        thread.start()
        self.threads.append(thread)

    def _drain(self):
        descriptor = os.open(self.folder / "fifo_read", os.O_RDWR | os.O_NONBLOCK)
        while not self.stop.wait(0.01):
            try:
                while os.read(descriptor, 1 << 16):
                    pass
            except BlockingIOError:
                pass
        os.close(descriptor)

    def _feed(self):
        """A scene for whoever reads."""
        while not self.stop.wait(0.02):
            try:
                descriptor = os.open(self.folder / "fifo_fed", os.O_WRONLY | os.O_NONBLOCK)
            except OSError:
                continue
            try:
                os.write(descriptor, SCENE.encode())
            except OSError:
                pass
            os.close(descriptor)

    def _accept(self):
        while not self.stop.is_set():
            try:
                caller, _ = self.sockets[0].accept()
            except OSError:
                continue
            with caller:
                while caller.recv(1 << 16):
                    pass

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.stop.set()
        for thread in self.threads:
            thread.join()
        for one in self.sockets:
            one.close()
        shutil.rmtree(self.folder, ignore_errors=True)
        shutil.rmtree(self.home, ignore_errors=True)

    def changes(self, written):
        """What is wrong with the folder after a command that was allowed to write to these names, links followed."""
        after = snapshot(self.folder)
        wrong = []
        for name, was in self.before.items():
            now = after.get(name)
            if now == was or any(name == w or name.startswith(w + "/") for w in written if w == "report"):
                continue
            if now is None:
                wrong.append(f"{name!r} is gone")
            elif now[:2] != was[:2]:
                wrong.append(f"{name!r} was replaced by something of another type")
            elif name not in written and not any(name.startswith(w + "/") for w in written if Path(w).name in ROWS):
                wrong.append(f"{name!r} was changed")
            elif not stat.S_ISREG(was[0]):
                wrong.append(f"{name!r} is no regular file and was changed")
        for name in after.keys() - self.before.keys():
            if ".draft." in name or name.endswith(".tmp"):
                wrong.append(f"{name!r} was left behind")
            elif not any(name == w or name.startswith(w + "/") for w in written):
                wrong.append(f"{name!r} was made unasked")
        return wrong
