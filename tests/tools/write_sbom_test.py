"""Checks the bill of materials that the build has written."""

import json
import pathlib
import shutil
import sys
import unittest

DOCUMENT = json.loads(pathlib.Path(sys.argv.pop()).read_text())
ROOT = pathlib.Path(__file__).resolve().parents[2]
LOCK = ROOT / "viewer/page/package-lock.json"


class BillOfMaterials(unittest.TestCase):
    def setUp(self):
        self.packages = {package["name"]: package for package in DOCUMENT["packages"]}

    def test_is_spdx(self):
        self.assertEqual((DOCUMENT["spdxVersion"], DOCUMENT["dataLicense"], DOCUMENT["SPDXID"]), ("SPDX-2.3", "CC0-1.0", "SPDXRef-DOCUMENT"))
        ids = {package["SPDXID"] for package in DOCUMENT["packages"]}
        self.assertEqual(len(ids), len(DOCUMENT["packages"]))
        for relation in DOCUMENT["relationships"]:
            self.assertIn(relation["spdxElementId"], ids | {"SPDXRef-DOCUMENT"})
            self.assertIn(relation["relatedSpdxElement"], ids)
        for package in DOCUMENT["packages"]:
            for key in ("versionInfo", "downloadLocation", "licenseConcluded", "licenseDeclared", "copyrightText"):
                self.assertTrue(package[key], (package["name"], key))

    def test_has_what_the_page_contains(self):
        locked = json.loads(LOCK.read_text())["packages"]
        for name in ("three", "uplot", "fflate"):
            self.assertEqual(self.packages[name]["versionInfo"], locked[f"node_modules/{name}"]["version"])
        self.assertNotIn("vite", self.packages)

    @unittest.skipUnless((ROOT / "build/ufbx/ufbx.h").exists(), "this build may be without ufbx")
    def test_has_the_sources_that_are_compiled_into_it(self):
        self.assertRegex(self.packages["ufbx"]["versionInfo"], r"^\d+\.\d+\.\d+$")
        self.assertEqual(self.packages["ufbx"]["licenseDeclared"], "MIT OR Unlicense")

    @unittest.skipUnless(shutil.which("dpkg-query"), "versions are known on Debian only")
    def test_has_what_is_compiled_and_linked(self):
        kinds = {relation["relatedSpdxElement"]: relation["relationshipType"] for relation in DOCUMENT["relationships"]}
        for begin, kind in (("libassimp5", "DYNAMIC_LINK"), ("libhdf5-103", "DYNAMIC_LINK"), ("libtbb12", "DYNAMIC_LINK"),
                            ("libboost", "DEPENDS_ON"), ("libeigen3", "DEPENDS_ON"), ("nlohmann-json3", "DEPENDS_ON"), ("rapidjson", "DEPENDS_ON")):
            found = [package for name, package in self.packages.items() if name.startswith(begin)]
            self.assertTrue(found, begin)
            self.assertEqual(kinds[found[0]["SPDXID"]], kind)
            self.assertNotEqual(found[0]["licenseDeclared"], "NOASSERTION")
        self.assertFalse([name for name in self.packages if name.startswith("libgtest")])


if __name__ == "__main__":
    unittest.main()
