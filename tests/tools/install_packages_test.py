#!/usr/bin/env python3
"""tools/install_packages with an apt and a dpkg-query of its own: what is missing is installed."""
import os
import re
import subprocess
import tempfile
import unittest
from pathlib import Path

SCRIPT = Path(__file__).resolve().parent.parent.parent / "tools" / "install_packages"
CHECKERS = ["clang-format-14", "clang-tidy-14"]
FONTS = ["fonts-wqy-microhei", "fonts-wqy-zenhei", "fonts-noto-cjk", "fonts-droid-fallback"]
# Has all but the packages in MISSING, and no archive has those in NOWHERE.
STUBS = {
    "dpkg-query": 'shift 2; for p; do [[ " $MISSING " == *" $p "* ]] || echo "installed $p"; done',
    "apt-get": 'echo "$@" >>"$SAID"',
    "apt-cache": '[[ " $NOWHERE " == *" $2 "* ]] && v="(none)" || v=1; echo "  Candidate: $v"',
    "id": "echo 0",
}


class InstallPackages(unittest.TestCase):
    def install(self, distribution, missing, nowhere=()):
        """Exit status and what apt-get was asked to install."""
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            for stub, text in STUBS.items():
                (folder / stub).write_text(f"#!/usr/bin/env bash\n{text}\n", encoding="utf-8")
                (folder / stub).chmod(0o755)
            system, version = distribution
            (folder / "os-release").write_text(f'ID={system}\nVERSION_ID="{version}"\n',
                                               encoding="utf-8")
            script = SCRIPT.read_text(encoding="utf-8")
            (folder / "script").write_text(script.replace("/etc/os-release",
                                                          str(folder / "os-release")))
            said = folder / "said"
            said.touch()
            environment = {**os.environ, "PATH": f"{folder}:{os.environ['PATH']}",
                           "MISSING": " ".join(missing), "NOWHERE": " ".join(nowhere),
                           "SAID": str(said)}
            done = subprocess.run(["bash", folder / "script", "--test"], capture_output=True,
                                  env=environment, text=True, check=False)
            asked = re.search(r"install --yes --no-install-recommends (.+)", said.read_text())
            return done.returncode, asked[1].split() if asked else []

    def test_nothing_is_done_where_nothing_is_missing(self):
        self.assertEqual(self.install(("debian", "12"), []), (0, []))

    def test_the_checkers_are_needed_where_a_distribution_has_them(self):
        for distribution in (("debian", "12"), ("ubuntu", "24.04")):
            for one in CHECKERS:
                self.assertEqual(self.install(distribution, [one]), (0, [one]))
                self.assertEqual(self.install(distribution, [one], [one])[0], 1)

    def test_they_are_left_out_where_there_are_none(self):
        debian_13 = ("debian", "13")
        self.assertEqual(self.install(debian_13, CHECKERS, CHECKERS), (0, []))
        self.assertEqual(self.install(debian_13, ["cmake", *CHECKERS], CHECKERS), (0, ["cmake"]))

    def test_of_alternatives_one_serves_and_the_first_that_an_archive_has_is_installed(self):
        ubuntu = ("ubuntu", "24.04")
        self.assertEqual(self.install(ubuntu, FONTS[:3]), (0, []))
        self.assertEqual(self.install(ubuntu, FONTS), (0, FONTS[:1]))
        self.assertEqual(self.install(ubuntu, FONTS, FONTS[:1]), (0, FONTS[1:2]))
        self.assertEqual(self.install(ubuntu, FONTS, FONTS[:3]), (0, FONTS[3:]))
        self.assertEqual(self.install(ubuntu, FONTS, FONTS)[0], 1)


if __name__ == "__main__":
    unittest.main()
