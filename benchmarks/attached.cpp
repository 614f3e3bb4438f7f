// How much a page slows a program down: steps with `viewer::attach` and a page that takes every frame as soon
// as it can, divided by steps without. Both take turns in one run.
//
//   supple_attached [ROUNDS] [STEPS] [MAX_SLOWDOWN]: steps of each turn; prints a line for each workload
#include <algorithm>
#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "supple/supple.hpp"
#include "supple/viewer.hpp"
#include "workloads/cloth_steps.hpp"
#include "workloads/deforming_copies.hpp"

namespace supple::benchmarks {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
using asio::ip::tcp;

/// A page that draws nothing: it reads each message and requests the next frame.
class Page {
 public:
  explicit Page(const std::string& url) {
    const std::size_t host = url.find("//") + 2, path = url.find('/', host);
    const std::string authority = url.substr(host, path - host), query = url.substr(path + 1);
    const auto port = static_cast<unsigned short>(std::stoi(authority.substr(authority.find(':') + 1)));
    socket_.next_layer().connect({asio::ip::make_address("127.0.0.1"), port});
    socket_.read_message_max(0);
    socket_.handshake(authority, "/session" + query);
    socket_.text(true);
    thread_ = std::thread([this] { read(); });
  }
  ~Page() { thread_.join(); }  // once the view is closed
  std::uint64_t messages() const { return messages_; }

 private:
  void read() {
    const std::string credit = R"({"do": "credit", "frames": 1})";
    beast::error_code error;
    for (beast::flat_buffer buffer; !error; buffer.clear()) {
      socket_.write(asio::buffer(credit), error);
      if (!error) socket_.read(buffer, error);
      ++messages_;
    }
  }

  asio::io_context context_;
  beast::websocket::stream<tcp::socket> socket_{context_};
  std::atomic<std::uint64_t> messages_ = 0;
  std::thread thread_;
};

struct Workload {
  std::string name;
  Scene scene;
  std::function<void(Scene&)> move;
};

double seconds_of(Workload& workload, int steps) {
  const auto begin = std::chrono::steady_clock::now();
  for (int i = 0; i < steps; ++i) {
    workload.move(workload.scene);
    workload.scene.detect();
  }
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

void measure(Workload& workload, int rounds, int steps, double max_slowdown) {
  seconds_of(workload, steps);  // takes memory
  std::vector<double> ratios, frames, waits;
  double alone = 0;
  for (int round = 0; round < rounds; ++round) {
    const auto attached = [&] {
      viewer::View view =
          viewer::attach(workload.scene, {.open_browser = false, .max_slowdown = max_slowdown});
      std::optional<Page> page(view.url());
      const double seconds = seconds_of(workload, steps);
      waits.push_back(view.seconds_in_steps() / seconds);
      frames.push_back(static_cast<double>(view.frame_count()) / seconds);
      view.close();
      page.reset();
      workload.scene.set_observer({});
      return seconds;
    };
    // In alternating order, so that a machine that gets slower or faster favours neither.
    const double first = round % 2 == 0 ? seconds_of(workload, steps) : attached();
    const double second = round % 2 == 0 ? attached() : seconds_of(workload, steps);
    ratios.push_back(round % 2 == 0 ? second / first : first / second);
    alone += round % 2 == 0 ? first : second;
  }
  std::sort(ratios.begin(), ratios.end());
  std::sort(frames.begin(), frames.end());
  std::sort(waits.begin(), waits.end());
  std::printf(
      "%-28s %7.2f ms a step, attached: %.3f of it (from %.3f to %.3f), of which it waits %.3f, "
      "%.0f frames a second\n",
      workload.name.c_str(), 1e3 * alone / rounds / steps, ratios[ratios.size() / 2], ratios.front(),
      ratios.back(), waits[waits.size() / 2], frames[frames.size() / 2]);
}

Workload deforming_spheres() {
  auto copies = std::make_shared<DeformingCopies>(*make_deforming_copies("18000x9"));
  Workload workload{"9 spheres of 18,000", Scene(), {}};
  std::vector<ObjectId> ids;
  for (std::size_t i = 0; i < copies->copies(); ++i)
    ids.push_back(workload.scene.add(copies->positions(i), copies->triangles()));
  workload.move = [copies, ids](Scene& scene) {
    copies->advance();
    for (std::size_t i = 0; i < ids.size(); ++i) scene.set_positions(ids[i], copies->positions(i));
  };
  return workload;
}

Workload crumpled_cloth() {
  auto cloth = std::make_shared<ClothStep>(*make_cloth_step("crumpled"));
  Workload workload{"crumpled cloth of 90,000", Scene(), {}};
  const ObjectId id = workload.scene.add(cloth->start, cloth->triangles, {.self_collision = true});
  workload.move = [cloth, id, at_end = false](Scene& scene) mutable {
    at_end = !at_end;
    scene.set_positions(id, at_end ? cloth->end : cloth->start);
  };
  return workload;
}

}  // namespace
}  // namespace supple::benchmarks

int main(int argc, char** argv) {
  using namespace supple::benchmarks;
  const int rounds = argc > 1 ? std::atoi(argv[1]) : 9, steps = argc > 2 ? std::atoi(argv[2]) : 200;
  const double max_slowdown = argc > 3 ? std::atof(argv[3]) : supple::viewer::AttachOptions{}.max_slowdown;
  for (const auto& make : {deforming_spheres, crumpled_cloth}) {
    Workload workload = make();
    measure(workload, rounds, steps, max_slowdown);
  }
}
