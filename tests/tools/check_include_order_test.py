"""The include-order check passes on this repository and fails on each constructed violation."""

import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
CHECK = ROOT / "tools/check_include_order.py"


def run_on(files):
    """Runs the check on a tree of the given files; returns (exit code, standard error)."""
    with tempfile.TemporaryDirectory() as folder:
        for name, text in files.items():
            path = pathlib.Path(folder, name)
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)
        done = subprocess.run([sys.executable, CHECK, folder], capture_output=True, text=True)
        return done.returncode, done.stderr


GOOD = {
    "include/supple/types.hpp": "#include <cstdint>\n",
    "include/supple/scene.hpp": '#include "supple/types.hpp"\n',
    "src/supple/core/parallel.hpp": "#include <tbb/parallel_for.h>\n",
    "src/supple/geometry/aabb.hpp": '#include "core/parallel.hpp"\n#include "supple/types.hpp"\n',
    "src/supple/octree/tree.hpp": "",
    "src/supple/octree/build.cpp": '#include "geometry/aabb.hpp"\n',
    "src/supple/mesh/scanner.hpp": "",
    "formats/include/supple/formats.hpp": '#include "supple/types.hpp"\n',
    "formats/src/load.cpp": '#include "mesh/scanner.hpp"\n#include "supple/formats.hpp"\n',
    "libs/files/include/supple/mesh_file.hpp": '#include "supple/types.hpp"\n',
    "libs/files/scanner.hpp": '#include "core/parallel.hpp"\n',
    "libs/files/obj.cpp": '#include "files/scanner.hpp"\n#include "supple/mesh_file.hpp"\n',
    "libs/verify/verify.hpp": "",
    "formats/src/text.cpp": '#include "files/scanner.hpp"\n',
    "recording/include/supple/recording.hpp": '#include "supple/types.hpp"\n',
    "recording/src/layout.hpp": "#include <hdf5.h>\n",
    "recording/src/reader.cpp": '#include "layout.hpp"\n#include "supple/recording.hpp"\n',
    "viewer/session/session.hpp": "",
    "viewer/session/session.cpp": '#include "session.hpp"\n#include "supple/types.hpp"\n',
    "viewer/export/page_file.hpp": "",
    "viewer/server/server.hpp": '#include "session/session.hpp"\n',
    "cli/options.hpp": "",
    "cli/view.cpp": '#include "server/server.hpp"\n#include "export/page_file.hpp"\n#include "session/session.hpp"\n',
    "cli/main.cpp": '#include <CLI/CLI.hpp>\n#include "options.hpp"\n#include "supple/formats.hpp"\n#include "supple/recording.hpp"\n',
}


class CheckIncludeOrder(unittest.TestCase):
    def test_this_repository(self):
        done = subprocess.run([sys.executable, CHECK], capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_good_tree(self):
        self.assertEqual(run_on(GOOD), (0, ""))

    def test_long_chain(self):
        files = [f"broad_phase/{name}.hpp" for name in "abcdef"]
        chain = {f"src/supple/{a}": f'#include "{b}"\n' for a, b in zip(files, files[1:])}
        code, error = run_on({**GOOD, **chain, "src/supple/broad_phase/f.hpp": ""})
        self.assertEqual(code, 1)
        self.assertIn("src/supple/broad_phase/a.hpp:1: ", error)
        self.assertIn("a chain of more than 5 files", error)
        del chain["src/supple/broad_phase/a.hpp"]
        self.assertEqual(run_on({**GOOD, **chain, "src/supple/broad_phase/f.hpp": ""}), (0, ""))

    def test_long_chain_of_a_program_or_a_component(self):
        for folder in ("cli", "viewer/server", "formats/src"):
            files = [f"room/{name}.hpp" for name in "abcdef"]
            chain = {f"{folder}/{a}": f'#include "{b}"\n' for a, b in zip(files, files[1:])}
            code, error = run_on({**GOOD, **chain, f"{folder}/room/f.hpp": ""})
            self.assertEqual(code, 1)
            self.assertIn(f"{folder}/room/a.hpp:1: room/a.hpp includes room/b.hpp includes", error)
            del chain[f"{folder}/room/a.hpp"]
            self.assertEqual(run_on({**GOOD, **chain, f"{folder}/room/f.hpp": ""}), (0, ""))

    def test_crowded_folder(self):
        files = {f"src/supple/mesh/polygon/{i}.cpp": "" for i in range(21)}
        code, error = run_on({**GOOD, **files})
        self.assertEqual(code, 1)
        self.assertIn("src/supple/mesh/polygon:1: polygon: a folder of 21 files", error)
        del files["src/supple/mesh/polygon/0.cpp"]
        self.assertEqual(run_on({**GOOD, **files}), (0, ""))
        for folder in ("cli", "viewer/session", "simulation/src/motion"):
            code, error = run_on({**GOOD, **{f"{folder}/room/{i}.cpp": "" for i in range(21)}})
            self.assertEqual(code, 1)
            self.assertIn(f"{folder}/room:1: room: a folder of 21 files", error)

    def expect(self, name, text, message):
        code, error = run_on({**GOOD, name: text})
        self.assertEqual(code, 1)
        self.assertEqual(len(error.splitlines()), 1, error)
        self.assertIn(f"{name}:2: ", error)
        self.assertIn(message, error)

    def test_upward_include(self):
        self.expect("src/supple/core/late.cpp", '\n#include "octree/build.hpp"\n', "no such header")
        self.expect("src/supple/core/late.cpp", '\n#include "geometry/aabb.hpp"\n', "core comes before geometry")

    def test_internal_header_without_its_layer(self):
        self.expect("src/supple/octree/short.cpp", '\n#include "build.hpp"\n', "by its layer")

    def test_threads_have_one_door(self):
        self.expect("src/supple/octree/threads.cpp", "\n#include <tbb/parallel_sort.h>\n", "only core/")

    def test_public_header_includes_internal_one(self):
        self.expect("include/supple/bad.hpp", '\n#include "core/parallel.hpp"\n', "only public headers")

    def test_public_header_includes_third_party(self):
        self.expect("include/supple/bad.hpp", "\n#include <hwy/highway.h>\n", "third party")

    def test_recording_header_names_no_third_party(self):
        self.expect("recording/include/supple/bad.hpp", "\n#include <hdf5/hdf5.h>\n", "third party")

    def test_program_includes_internal_header(self):
        for program in ("recording/src", "viewer/session", "viewer/server", "viewer/export", "cli", "examples", "benchmarks"):
            self.expect(f"{program}/bad.cpp", '\n#include "core/parallel.hpp"\n', "only public headers")

    def test_viewer_is_included_in_one_direction(self):
        for name, include in (
            ("viewer/session/bad.cpp", "server/server.hpp"),
            ("viewer/export/bad.cpp", "session/session.hpp"),
            ("viewer/server/bad.cpp", "export/page_file.hpp"),
            ("viewer/server/bad.cpp", "session/missing.hpp"),
            ("examples/bad.cpp", "session/session.hpp"),
        ):
            self.expect(name, f'\n#include "{include}"\n', "only public headers")

    def test_formats_build_on_meshes_only(self):
        self.expect("formats/src/bad.cpp", '\n#include "octree/tree.hpp"\n', "mesh comes before octree")
        self.expect("src/supple/mesh/bad.cpp", '\n#include "octree/tree.hpp"\n', "mesh comes before octree")

    def test_the_core_knows_no_library(self):
        for name in ("files/scanner.hpp", "supple/mesh_file.hpp"):
            self.expect("src/supple/octree/bad.cpp", f'\n#include "{name}"\n', "by its layer")
        self.expect("include/supple/bad.hpp", '\n#include "supple/mesh_file.hpp"\n', "only those of the core")

    def test_libraries_include_those_that_they_name(self):
        self.expect("libs/files/bad.cpp", '\n#include "verify/verify.hpp"\n', "by its layer")
        self.expect("formats/src/bad.cpp", '\n#include "verify/verify.hpp"\n', "by its layer")

    def test_experiments_are_built_on_the_command_line(self):
        files = {"cli/text.hpp": "", "experiments/fit.hpp": "", "experiments/fit.cpp": '\n#include "text.hpp"\n'}
        self.assertEqual(run_on({**GOOD, **files})[0], 0)
        self.expect("cli/bad.cpp", '\n#include "experiments/fit.hpp"\n', "same folder")

    def test_program_leaves_its_folder(self):
        self.expect("examples/bad.cpp", '\n#include "../cli/options.hpp"\n', "same folder")

    def test_file_outside_the_layers(self):
        code, error = run_on({**GOOD, "src/supple/misc/a.cpp": ""})
        self.assertEqual(code, 1)
        self.assertIn("not in a layer", error)


if __name__ == "__main__":
    unittest.main()
