#include <atomic>
#include <chrono>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <thread>
#include <type_traits>
#include <utility>

#include "export/embedded.hpp"
#include "gate.hpp"
#include "server/access.hpp"
#include "server/browser_visit.hpp"
#include "server/server.hpp"
#include "session/failure.hpp"
#include "session/program/attach_descriptions.hpp"
#include "session/program/program_source.hpp"
#include "session/session.hpp"
#include "supple/error.hpp"
#include "supple/viewer.hpp"
#include "view_file/view_file.hpp"

namespace supple::viewer {
namespace {

double seconds_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::shared_ptr<Gate> gate_of(const Scene& scene, const AttachOptions& options, std::function<void()> wake) {
  for_each_leaf(
      [&]<class Struct, class Value>(const Field<Struct, Value>& field, const Value& value) {
        if constexpr (std::is_same_v<Value, double>) {
          if (!field.range.allows(value))
            fail(std::string("attach: ") + field.key + " is " + text_of(value) + "; it must be " +
                 text_of(field.range, false));
        }
      },
      options);
  check(options.breaks, scene.options().contacts);
  if (embedded_page().empty())
    fail(
        "attach: the library was built without the page of the viewer; configure the build with "
        "-DSUPPLE_BUILD_VIEWER=ON");
  return std::make_shared<Gate>(options, Gate::Surroundings{&seconds_now, std::move(wake)});
}

}  // namespace

/// The threads of the session and of the network, which this object starts and joins.
class View::Implementation {
 public:
  Implementation(const Scene& scene, const AttachOptions& options)
      : scene_(&scene),
        gate_(gate_of(scene, options, [this] { wake(); })),
        watching_page_(options.spectators ? page_of_spectators(embedded_page()) : ""),
        server_(std::make_unique<Server>(
            Session(view_of_program(scene, gate_, options.title.empty() ? "my program" : options.title),
                    {.history_bytes = options.history_bytes}),
            ServerOptions{.address = options.address,
                          .port = options.port,
                          .page = embedded_page(),
                          .watching_page = watching_page_,
                          .token = options.token_file.empty() ? "" : token_of_file(options.token_file)})),
        url_(server_->url()),
        watching_url_(server_->watching_url()),
        awake_(server_.get()),
        network_([this] { serve(); }) {
    if (options.open_browser) visit_.emplace(url_);
  }
  ~Implementation() { close(); }
  Implementation(const Implementation&) = delete;
  Implementation& operator=(const Implementation&) = delete;

  const std::shared_ptr<Gate>& gate() const { return gate_; }
  const std::string& url() const { return url_; }
  const std::string& watching_url() const { return watching_url_; }
  const Scene& scene() const { return *scene_; }
  void wait(const CallLimits& limits) { gate_->wait(*scene_, limits); }

  void close() {
    is_closing_ = true;
    gate_->close();
    const std::lock_guard lock(joining_);
    if (network_.joinable()) network_.join();
  }

 private:
  void wake() {
    const std::lock_guard lock(waking_);
    if (awake_ != nullptr) awake_->wake();
  }

  void serve() {
    try {
      server_->run([this] { return is_closing_.load(); });
    } catch (const std::exception&) {
      // The page shows why the session has failed, and the program goes on.
    }
    gate_->close();
    {
      const std::lock_guard lock(waking_);
      awake_ = nullptr;
    }
    server_.reset();  // ends the thread of the session, and frees the port
    gate_->leave();
  }

  const Scene* scene_;
  std::shared_ptr<Gate> gate_;
  std::string watching_page_;
  std::unique_ptr<Server> server_;
  std::string url_, watching_url_;
  std::optional<BrowserVisit> visit_;
  std::mutex waking_;
  Server* awake_;  ///< null when the session has ended; guarded by the mutex
  std::atomic<bool> is_closing_ = false;
  std::mutex joining_;
  std::thread network_;  ///< last member: it uses all others
};

View::View(std::unique_ptr<Implementation> implementation) : implementation_(std::move(implementation)) {}
View::View(View&&) noexcept = default;
View& View::operator=(View&&) noexcept = default;
View::~View() = default;

const std::string& View::url() const {
  return implementation_->url();
}
const std::string& View::watching_url() const {
  return implementation_->watching_url();
}
std::uint64_t View::step_count() const {
  return implementation_->gate()->state().step_count;
}
std::uint64_t View::frame_count() const {
  return implementation_->gate()->frame_count();
}
double View::seconds_in_steps() const {
  return implementation_->gate()->seconds_in_steps();
}
bool View::is_paused() const {
  return !implementation_->gate()->state().runs;
}
void View::set_breaks(const BreakOptions& breaks) {
  implementation_->gate()->set_breaks(breaks);
}
void View::set_field(ObjectId object, std::string_view name, std::span<const double> values,
                     std::optional<FieldElement> element) {
  implementation_->gate()->user_fields().set(implementation_->scene(), object, name, values, false, element);
}
void View::set_field(ObjectId object, std::string_view name, std::span<const Vec3d> values,
                     std::optional<FieldElement> element) {
  static_assert(sizeof(Vec3d) == 3 * sizeof(double));
  const std::span<const double> numbers(reinterpret_cast<const double*>(values.data()), 3 * values.size());
  implementation_->gate()->user_fields().set(implementation_->scene(), object, name, numbers, true, element);
}
void View::wait(const CallLimits& limits) {
  implementation_->wait(limits);
}
void View::close() {
  implementation_->close();
}

View attach(Scene& scene, const AttachOptions& options) {
  auto made = std::make_unique<View::Implementation>(scene, options);
  // The observer may outlive the view: it then does nothing.
  scene.set_observer(
      [gate = made->gate()](const Scene& seen, const DetectRequest& request) { gate->pass(seen, request); });
  return View(std::move(made));
}

View attach(Simulation& simulation, const AttachOptions& options) {
  AttachOptions completed = options;
  if (completed.time_step == 0) completed.time_step = simulation.options().time_step;
  auto made = std::make_unique<View::Implementation>(simulation.scene(), completed);
  simulation.set_observer(
      [gate = made->gate()](const Scene& seen, const DetectRequest& request) { gate->pass(seen, request); });
  return View(std::move(made));
}

}  // namespace supple::viewer
