#pragma once

// The ends of the help of each command: examples, and what an input looks like.

namespace supple::cli {

inline constexpr const char* program_footer = R"(Examples:
  supple detect rabbit.obj fish.ply         which triangles of the two intersect?
  supple detect --contacts continuous --self --sequence 'frame_*.obj'
                                            what touches between two frames, and when?
  supple detect --help                      every option, with examples
  supple simulate scene.toml --frames 300 --record run.h5
                                            simulate moving objects and record their contacts
  supple view run.h5                        view a scene or a recording in a browser
  supple render run.h5 -o figure.png        draw frames as pictures, without a window
  supple info rabbit.obj                    counts, bounds, holes, octree statistics
  supple query closest points.txt body.obj  nearest triangles of points; also inside, rays, distance
  supple ccd-queries edge-edge/*.csv        continuous queries, compared with published answers
  supple experiment scaling --quick         how does the time grow with the number of objects?
  supple diff a.h5 b.h5                     where do two recordings differ first?

Exit status: 0 means success. 1 means that something touches (with --fail-on-contact) or that two
recordings differ (diff). 2 means a usage or input error, which is reported in one line, a motion that blew
up (simulate), or that nothing touches but something was not tested (--fail-on-contact): an object alone,
nothing that moves, or a run that --time-limit ended. 3 means that brute force gives a different result
(--verify) or that an answer is false (ccd-queries). 130 and 143 mean that detect, query or simulate was
interrupted; its files are whole, have what was found, and say that they are truncated. They also mean that
render was interrupted: it keeps the pictures that it has written. view exits with 0
when it is interrupted.)";

inline constexpr const char* detect_footer = R"(Examples:
  supple detect rabbit.obj fish.ply
      Two static meshes, one object each: which of their triangles intersect?
  supple detect --self cloth.obj --json result.json --contact-details
      Where does a cloth intersect itself? Each contact with its points, as JSON.
  supple detect --sequence 'frame_*.ply' --self --csv pairs.csv
      Frames of one object. Quote the pattern, so that frame_10 comes after frame_9 and not after
      frame_1.
  supple detect scene.toml --frames 300
      A scene file: objects with placement, options and motion.
  supple detect run.h5 --verify
      Detects the contacts of a recording again, with the recorded options. Options of the command line
      replace them.
  supple detect a.stl b.stl --fail-on-contact --quiet && echo apart
      For scripts: the exit status is 1 when something touches, and 2 when nothing could be tested.
  supple detect a.obj b.obj --max-contacts 1000 --time-limit 60 --json result.json
      At most 1000 contacts of each kind and a minute. The JSON says whether it is truncated.
  supple detect --contacts continuous --self --sequence 'frame_*.ply' --json impacts.json
      Every vertex and face and every two edges that touch on their paths between two frames, and the time
      when they do.
  supple detect --contacts continuous --min-separation 0.001 scene.toml --frames 300
      Elements count as touching when they come within 0.001.
  supple detect --contacts proximity --margin 0.005 cloth.obj body.obj --json near.json
      What is within 0.01, the sum of both margins, and how far. One mesh alone is near itself.
  supple detect a.obj b.obj --contacts penetration --solid --json inside.json
      Which vertices of one are inside the other, how deep, and the curves in which they intersect.
  supple detect rabbit.obj fish.ply --verify
      Check the result against exact brute force over all pairs of triangles.
  supple detect rabbit.obj fish.ply --object-octree regular --leaf-size 1 --node-pairs 0 1
      The narrow phase of the paper: the pairs of octree nodes that collide, level by level.
  mpirun -n 8 supple detect scene.toml --json result.json
      One scene on eight ranks of MPI, on one or several machines, with the result of one process.
  supple detect a.obj b.obj --json - --no-stats | sha256sum
      The same input gives the same bytes for any number of threads and any broad phase.)";

inline constexpr const char* diff_footer = R"(Examples:
  supple diff a.h5 b.h5
      The first frame and item in which two recordings differ, with both values. The exit status is 1
      when they differ.
  supple diff a.h5 b.h5 --tolerance 1e-9
      Positions, points, times, barycentric coordinates and normals may differ by 1e-9.
  supple diff a.h5 b.h5 --quiet && echo equal
      For scripts.
  supple diff a.h5 b.h5 --json -
      The same as JSON on standard output.

Measured times, and counts that depend on the number of threads, are not compared.)";

inline constexpr const char* simulate_footer = R"(Examples:
  supple simulate scenes/rabbit_pile.toml
      Rabbits fall on each other. Prints the contacts, the speed, and the time of each stage.
  supple simulate scenes/fish_tank.toml --seconds 10 --record run.h5
      Writes every frame and contact to an HDF5 file. ParaView opens run.xdmf next to it.
  supple simulate scenes/table1_9.toml --frames 1000 --seed 7 --json - --no-stats
      Another seed gives the objects other directions. The same seed gives the same bytes on every
      machine.
  supple simulate scenes/cloth_over_ball.toml --contacts continuous --self
      Continuous contacts between two frames, including those of an object with itself.
  mpirun -n 8 supple simulate scenes/nine.toml --record run.h5
      The objects on eight ranks of MPI, with the motion, contacts and recording of one process.
  supple simulate scenes/soft_block.toml --time-step 0.001
      Shorter steps than in the scene file.

Frame 0 is the start, and frame k is the state after k steps. The continuous contacts of frame k are those
on the paths from frame k - 1 to frame k. Ctrl-C ends the run; files and tables are complete up to the last
whole step.)";

inline constexpr const char* view_footer = R"(Examples:
  supple view scenes/nine.toml
      Objects that deform and touch: watch them, pull a vertex, look into the octrees.
  supple view run.h5
      A recording of supple simulate --record: play it, go back, jump to frames in which objects begin
      to touch.
  supple view rabbit.obj fish.ply
      Meshes, one object each: where do they touch, and why do two triangles not touch?
  supple view --sequence 'frame_*.ply' --self
      Frames of one object, with its contacts with itself.
  supple view scenes/soft_block.toml --no-open --port 8080
      On a remote machine: ssh -L 8080:127.0.0.1:8080 makes the page available on your machine.
  supple view scenes/nine.toml --export nine.html
      One file to send. It opens in any browser, without supple and without a server.

The address contains a new token in each run, so that nobody else can open the page; --token-file keeps the
token. The program opens a temporary file in the browser, which leads to the address. Only you can read that
file. A browser from a Snap or a Flatpak may not see it: open the printed address instead. Ctrl-C ends the
program, and the page says that it has ended.)";

inline constexpr const char* render_footer = R"(Examples:
  supple render run.h5 --view view.json -o figure.png
      One picture of a recording, as the page showed it when Save view wrote view.json.
  supple render scenes/nine.toml --frames 0-300:3 -o film/%04d.png
      Every third step of a simulation, for a film.
  supple render rabbit.obj fish.ply --size 80x60mm --dpi 600 --legend --scale-bar -o figure.png
      A figure for a paper, as large as in print.
  supple render rabbit.obj fish.ply --view view.json -o figure.svg
      The lines of the view as SVG: outlines, wireframes, contact segments and points.
  supple render scenes/nine.toml --frames 0-300 --plot contacts --size 120x60mm -o contacts.svg
      A plot of the page: the contacts in each of the first 300 steps.

A Chromium draws the pictures as it draws the page, so they look the same. It needs no window and no graphics
card. Ctrl-C ends the program and its browser; files that are written are whole.)";

inline constexpr const char* info_footer = R"(Examples:
  supple info rabbit.obj
      Counts, bounds, open or closed, connected components, and the quality of its octree.
  supple info scans/*.ply --json -
      The same for many meshes, as JSON on standard output.
  supple info scene.toml
      Every object of a scene, as it is placed.)";

inline constexpr const char* query_footer = R"(Examples:
  supple query closest points.txt rabbit.obj fish.ply
      The nearest triangle of each point, and its distance.
  supple query inside points.txt rabbit.obj --json -
      Which points are inside, outside or on the surface? It must be closed.
  supple query inside points.txt export.obj --weld
      Vertices at equal positions count as one, so that seams of an export do not open the surface.
  supple query rays rays.txt scene.toml --all-hits --json hits.json
      The first triangle on each ray, and how many triangles there are on the whole ray.
  supple query distance rabbit.obj fish.ply --max-distance 0.1
      How far are objects apart, and where are they nearest? Each two within 0.1.
  supple query closest points.txt rabbit.obj --verify
      Check each answer against exact brute force over all triangles.

A file of points has three numbers a line; a file of rays has six, the origin and the direction, which
need not have length 1. Blanks or commas separate the numbers. Of several triangles at the same distance,
the one with the smallest number counts; exact arithmetic decides. Objects of a scene file or a recording
are where they start.)";

inline constexpr const char* ccd_queries_footer = R"(Examples:
  supple ccd-queries sample-queries/*/vertex-face/*.csv
      How many queries touch, how many results differ from the published answers, and how long does a
      query take?
  supple ccd-queries --kind edge-edge queries.csv --list-false
      The kind follows from a folder vertex-face or edge-edge, or a file name that ends in vf or ee;
      else use --kind.
  supple ccd-queries 227vf.csv --answers 227vf_mma_bool.json
      The answers are in a JSON list of true and false.
  supple ccd-queries data.csv --kind vertex-face --min-separation 0.01 --verify
      Elements within 0.01 count as touching. Algebra decides each query a second time.
  supple ccd-queries 227vf.csv --json - --no-stats
      Writes the time of every impact as JSON, the same bytes in every run.

A query is eight rows: the vertices v, f0, f1, f2 of a vertex and a face, or a0, a1, b0, b1 of two edges,
at the start of the step, and then at its end. A row has numerator,denominator of x, y and z, as whole
numbers of any size. It may also have the answer, 0 or 1, the same in all eight rows. Each coordinate must
be representable as a double.)";

}  // namespace supple::cli
