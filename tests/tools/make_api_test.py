"""make_api reads a header with every kind of entity, and check_api compares the result with documents and bindings."""

import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

TOOLS = pathlib.Path(__file__).resolve().parents[2] / "tools"
HAS_LIBCLANG = subprocess.run([sys.executable, "-Bc", "import make_api; raise SystemExit(make_api.cindex is None)"], cwd=TOOLS).returncode == 0

CORE = """#pragma once
// Not documentation.
/// The version.
#define SUPPLE_NUMBER 3
namespace supple {

/// A color.
///
/// Two paragraphs: a list
/// - one,
///   still one,
/// - two.
/// After the list.
enum class Color : unsigned char {
  red = 1,  ///< warm,
            ///< like fire
  /// Cold.
  blue,
};
enum class Plain { a, b };

/// Options.
struct PaintOptions {
  int a = 1, b{2};  ///< shared
  /// Before.
  Color color = Color::red;
  const char* name = nullptr;

  bool operator==(const PaintOptions&) const = default;
};

/// A number of a type.
template <class Scalar>
concept Number = sizeof(Scalar) > 1;

struct Base {};
/// Paints.
class Painter : public Base {
 public:
  /// Starts.
  explicit Painter(const PaintOptions& options = {});
  ~Painter();
  /// Adds one.
  [[nodiscard]] int add(int count, int = 4) const;
  int add(double count) const;
  static Painter make();
  template <Number Scalar>
  requires(sizeof(Scalar) > 2) Scalar get(Scalar value);
  Painter& operator+=(int count);
  friend Painter operator+(Painter a, Painter b);
  /// Inside.
  struct Brush {
    int width = 0;
  };

 private:
  int hidden_ = 0;
};

/// Three numbers.
using Numbers = int[3];
/// A limit.
inline constexpr double limit = 0x1p-3, other = 2;
/// Mixes.
Color mix(Color a, Color b = Color::blue);
Color mix(int a);
namespace inner {
/// Nested.
void nested();
}  // namespace inner
namespace detail {
struct Secret {};
}  // namespace detail
template <class T>
struct Description;
template <>
struct Description<Color> {};

}  // namespace supple
"""
DOCUMENT = "`PaintOptions` have `a`, `b`, `name`: `Painter` has `add`, `make`, `get`; `mix`, `nested`, `limit`, `Number`\n"


@unittest.skipUnless(HAS_LIBCLANG, "needs libclang for Python (python3-clang-19)")
class MakeApi(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        self.write("include/supple/paint.hpp", CORE)
        self.write("shapes/include/supple/shapes.hpp", '#include "supple/paint.hpp"\n')
        self.write("docs/paint.md", DOCUMENT)
        self.assertEqual(self.run_tool("make_api"), (0, ""))

    def write(self, name, text):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)

    def run_tool(self, name, *arguments):
        done = subprocess.run([sys.executable, TOOLS / f"{name}.py", *arguments, self.root], capture_output=True, text=True)
        return done.returncode, done.stderr

    def entities(self):
        headers = json.loads((self.root / "docs/api.json").read_text())["headers"]
        self.assertEqual([(header["library"], header["name"]) for header in headers],
                         [("core", "supple/paint.hpp"), ("shapes", "supple/shapes.hpp")])
        return headers[0]["entities"]

    def entity(self, name):
        found = [entity for entity in self.entities() if entity["name"] == name]
        self.assertEqual(len(found), 1, name)
        return found[0]

    def test_kinds_in_the_order_of_the_header(self):
        self.assertEqual([(entity["kind"], entity["name"]) for entity in self.entities()], [
            ("macro", "SUPPLE_NUMBER"), ("enum", "Color"), ("enum", "Plain"), ("struct", "PaintOptions"),
            ("concept", "Number"), ("struct", "Base"), ("class", "Painter"), ("struct", "Painter::Brush"),
            ("alias", "Numbers"), ("constant", "limit"), ("constant", "other"), ("function", "mix"), ("function", "mix"),
            ("function", "inner::nested"), ("struct", "Description")])

    def test_enumerations(self):
        self.assertEqual(self.entity("Color"), {
            "kind": "enum", "name": "Color", "type": "unsigned char",
            "doc": "A color.\n\nTwo paragraphs: a list\n- one, still one,\n- two.\nAfter the list.",
            "values": [{"name": "red", "value": 1, "doc": "warm, like fire"}, {"name": "blue", "value": 2, "doc": "Cold."}]})
        self.assertEqual(self.entity("Plain")["values"], [{"name": "a", "value": 0}, {"name": "b", "value": 1}])

    def test_fields(self):
        self.assertEqual(self.entity("PaintOptions"), {"kind": "struct", "name": "PaintOptions", "doc": "Options.", "fields": [
            {"name": "a", "type": "int", "default": "1", "doc": "shared"},
            {"name": "b", "type": "int", "default": "{2}", "doc": "shared"},
            {"name": "color", "type": "Color", "default": "Color::red", "doc": "Before."},
            {"name": "name", "type": "const char*", "default": "nullptr", "follows": True}]})

    def test_classes(self):
        painter = self.entity("Painter")
        self.assertEqual(painter["bases"], ["Base"])
        self.assertNotIn("fields", painter)
        self.assertEqual(painter["constructors"], [{"name": "Painter", "doc": "Starts.", "parameters": [
            {"name": "options", "type": "const PaintOptions&", "default": "{}"}]}])
        self.assertEqual(painter["methods"], [
            {"name": "add", "parameters": [{"name": "count", "type": "int"}, {"type": "int"}], "returns": "int", "const": True, "doc": "Adds one."},
            {"name": "add", "parameters": [{"name": "count", "type": "double"}], "returns": "int", "const": True, "follows": True},
            {"name": "make", "parameters": [], "returns": "Painter", "static": True, "follows": True},
            {"name": "get", "template": ["Number Scalar"], "requires": "(sizeof(Scalar) > 2)",
             "parameters": [{"name": "value", "type": "Scalar"}], "returns": "Scalar", "follows": True}])
        self.assertEqual([operator["name"] for operator in painter["operators"]], ["operator+=", "operator+"])

    def test_functions_and_constants(self):
        mix = [entity for entity in self.entities() if entity["name"] == "mix"]
        self.assertEqual(mix[0]["parameters"][1], {"name": "b", "type": "Color", "default": "Color::blue"})
        self.assertEqual((mix[0]["returns"], mix[0]["doc"], mix[1]["follows"]), ("Color", "Mixes.", True))
        self.assertEqual(self.entity("limit"), {"kind": "constant", "name": "limit", "type": "const double", "value": "0x1p-3", "doc": "A limit."})
        self.assertEqual(self.entity("SUPPLE_NUMBER"), {"kind": "macro", "name": "SUPPLE_NUMBER", "value": "3", "doc": "The version."})
        self.assertEqual(self.entity("Number")["value"], "sizeof(Scalar) > 1")
        self.assertEqual(self.entity("Numbers")["type"], "int[3]")

    def test_check_names_what_differs(self):
        self.assertEqual(self.run_tool("make_api", "--check"), (0, ""))
        self.write("include/supple/paint.hpp", CORE.replace("Mixes.", "Stirs."))
        code, error = self.run_tool("make_api", "--check")
        self.assertEqual((code, error), (1, "docs/api.json: differs from the headers in mix; run: make docs\n"))

    def test_a_header_that_does_not_compile(self):
        self.write("include/supple/paint.hpp", "int a = ;\n")
        code, error = self.run_tool("make_api")
        self.assertEqual(code, 1)
        self.assertIn("include/supple/paint.hpp:1: ", error)

    def test_missing_documentation(self):
        code, error = self.run_tool("check_api")
        self.assertEqual(code, 1)
        missing = {line.split(": ")[0] for line in error.splitlines() if line.endswith(": has no doc comment")}
        self.assertEqual(missing, {"Plain", "Base", "Description"})
        unmentioned = {line.split(": ")[0] for line in error.splitlines() if line.endswith(": no document mentions it")}
        self.assertEqual(unmentioned, {"SUPPLE_NUMBER", "Plain", "Painter::Brush", "Numbers", "other", "Description"})

    def test_bindings(self):
        names = [name for entity in self.entities() for name in
                 [entity["name"], *(f"{entity['name']}::{member['name']}" for key in ("values", "fields", "methods") for member in entity.get(key, []))]]
        without = [name for name in names if not name.startswith("Painter")]
        for binding, expected in (({"names": names}, set()),
                                  ({"names": without, "left_out": {"Painter": "no brushes"}}, set()),
                                  ({"names": without + ["Painter"], "left_out": {"Painter::Brush": "none"}},
                                   {f"Painter::{name}: is missing" for name in ("add", "make", "get")}),
                                  ({"names": names + ["Scene"], "left_out": {"mix": "no"}},
                                   {"Scene: is not in the interface", "mix: is both bound and left out"}),
                                  ({"names": [], "libraries": ["shapes"]}, set())):
            self.write("binding.json", json.dumps(binding))
            file = str(self.root / "binding.json")
            lines = self.run_tool("check_api", "--binding", file)[1].splitlines()
            self.assertEqual({line.removeprefix(f"{file}: ").split(";")[0] for line in lines if line.startswith(file)}, expected)


if __name__ == "__main__":
    unittest.main()
