#include "pins/pin_meter.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "sources/extent.hpp"
#include "supple/result_lists.hpp"

namespace supple::viewer {
namespace {

double smaller(double known, double value) {
  return std::isnan(known) ? value : std::min(known, value);
}
double larger(double known, double value) {
  return std::isnan(known) ? value : std::max(known, value);
}

/// Gathers what the lists of a result say about one pin.
class Gathering {
 public:
  Gathering(const DetectResult& result, const Pin& pin) : result_(result), pin_(pin) {}

  PinValues values() {
    for_each_list([&](const auto& list, auto member) {
      if constexpr (requires { member(result_).front().normal, member(result_).front().object_a; }) {
        if (list.answers != ContactKinds::none) add_all(member(result_));
      }
    });
    add_curves();
    if (const double length = norm(normal_); length > 0) {
      values_.normal_x = normal_.x / length;
      values_.normal_y = normal_.y / length;
      values_.normal_z = normal_.z / length;
    }
    return values_;
  }

 private:
  bool concerns(ObjectId a, ObjectId b) const {
    const std::uint32_t first = pin_.objects.front().index, last = pin_.objects.back().index;
    if (pin_.objects.size() == 1) return a.index == first || b.index == first;
    return (a.index == first && b.index == last) || (a.index == last && b.index == first);
  }
  /// Contacts of other kinds cannot be followed alone.
  bool is_wanted(const auto&) const { return pin_.contact.empty(); }
  bool is_wanted(const Contact& c) const {
    const std::vector<std::uint32_t>& key = pin_.contact;
    return key.empty() || (key.size() == 4 && key[0] == c.object_a.index && key[1] == c.triangle_a &&
                           key[2] == c.object_b.index && key[3] == c.triangle_b);
  }
  bool is_wanted(const ContinuousContact& c) const {
    const std::vector<std::uint32_t>& key = pin_.contact;
    return key.empty() ||
           (key.size() == 7 && key[0] == c.object_a.index && key[1] == c.element_a[0] &&
            key[2] == c.element_a[1] && key[3] == c.object_b.index && key[4] == c.element_b[0] &&
            key[5] == c.element_b[1] && key[6] == static_cast<std::uint32_t>(c.kind));
  }
  /// Adds a normal from b to a. An object has contacts on many sides, so it has none.
  void add_normal(ObjectId a, const Vec3d& normal) {
    if (pin_.objects.size() == 1) return;
    const bool is_first = a.index == pin_.objects.front().index;
    normal_ = normal_ + (is_first ? 1.0 : -1.0) * normal;
  }

  /// Adds the rows of one kind of contacts. They are sorted by their objects.
  template <class Row>
  void add_all(std::span<const Row> rows) {
    const auto objects = [](const Row& row) { return std::pair(row.object_a, row.object_b); };
    for (auto row = rows.begin(); row != rows.end();) {
      const auto end = std::ranges::upper_bound(row, rows.end(), objects(*row), {}, objects);
      if (concerns(row->object_a, row->object_b))
        std::for_each(row, end, [&](const Row& each) { add(each); });
      row = end;
    }
  }
  template <class Row>
  void add(const Row& row) {
    if (!is_wanted(row)) return;
    ++values_.contacts;
    add_normal(row.object_a, row.normal);
    if constexpr (requires { row.toi; }) values_.impact_time = smaller(values_.impact_time, row.toi);
    if constexpr (requires { row.distance; }) values_.gap = smaller(values_.gap, row.distance);
    if constexpr (requires { row.depth; }) values_.depth = larger(values_.depth, row.depth);
    if constexpr (requires { result_.points_of(row); }) {
      found_ = static_cast<std::uint32_t>(&row - result_.contacts.data());
      const auto points = result_.points_of(row);
      if (points.size() != 2) return;
      const double length = norm(points[1].position - points[0].position);
      values_.length = std::isnan(values_.length) ? length : values_.length + length;
    }
  }
  /// The curves of the objects, or those that go through the contact.
  void add_curves() {
    for (const IntersectionCurve& curve : result_.curves) {
      if (!concerns(curve.a, curve.b)) continue;
      const auto through = result_.contacts_of(curve);
      if (!pin_.contact.empty() &&
          (!found_ || std::find(through.begin(), through.end(), *found_) == through.end()))
        continue;
      values_.depth = larger(values_.depth, curve.depth);
      if (curve.kind != CurveKind::closed) continue;
      values_.area = (std::isnan(values_.area) ? 0 : values_.area) + norm(curve.area);
    }
  }

  const DetectResult& result_;
  const Pin& pin_;
  PinValues values_;
  Vec3d normal_{};
  std::optional<std::uint32_t> found_{};  // the last contact that counts, an index into `contacts`
};

std::vector<Vec3d> positions_of(const Scene& scene, ObjectId object) {
  std::vector<Vec3d> positions(scene.vertex_count(object));
  for (std::size_t i = 0; i < positions.size(); ++i)
    positions[i] = scene.position(object, static_cast<std::uint32_t>(i));
  return positions;
}

double displacement_of(std::span<const Vec3d> positions, const Pin& pin) {
  double displacement = PinValues::nothing;
  if (!pin.start) return displacement;
  for (std::size_t i = 0; i < std::min(positions.size(), pin.start->size()); ++i) {
    if (is_finite(positions[i]) && is_finite((*pin.start)[i]))
      displacement = larger(displacement, norm(positions[i] - (*pin.start)[i]));
  }
  return displacement;
}

PinValues values_of_missing() {
  PinValues values;
  values.contacts = PinValues::nothing;
  return values;
}

}  // namespace

std::optional<Vec3d> center_of(std::span<const Vec3d> points) {
  Vec3d sum{};
  std::size_t count = 0;
  for (const Vec3d& p : points) {
    if (!is_finite(p)) continue;
    sum = sum + p;
    ++count;
  }
  if (count == 0) return std::nullopt;
  return (1.0 / static_cast<double>(count)) * sum;
}

void PinMeter::set(std::vector<Pin> pins) {
  std::vector<Path> paths(pins.size());
  for (std::size_t i = 0; i < pins.size(); ++i) {
    const auto same = std::find_if(pins_.begin(), pins_.end(),
                                   [&](const Pin& pin) { return pin.number == pins[i].number; });
    if (same != pins_.end()) paths[i] = paths_[static_cast<std::size_t>(same - pins_.begin())];
  }
  pins_ = std::move(pins);
  paths_ = std::move(paths);
}

void PinMeter::forget() {
  std::fill(paths_.begin(), paths_.end(), Path{});
}

void PinMeter::measure(const Scene& scene, std::uint64_t step, double time, std::vector<PinRow>& rows,
                       const Earlier& earlier) {
  for (std::size_t i = 0; i < pins_.size(); ++i) {
    const Pin& pin = pins_[i];
    const bool exists = std::all_of(pin.objects.begin(), pin.objects.end(),
                                    [&](ObjectId object) { return scene.contains(object); });
    PinRow row{pin.number, step, time,
               exists ? Gathering(scene.result(), pin).values() : values_of_missing()};
    if (exists && pin.objects.size() == 1) {
      const std::vector<Vec3d> positions = positions_of(scene, pin.objects.front());
      row.values.displacement = displacement_of(positions, pin);
      Path& path = paths_[i];
      if (path.now && path.now->step != step) path.before = std::exchange(path.now, std::nullopt);
      const auto center = center_of(positions);
      if (center) path.now = Place{step, time, *center};
      if (earlier && step > 0 && !(path.before && path.before->step + 1 == step))
        path.before = earlier(pin.objects.front());
      const std::optional<Place>& before = path.before;
      if (center && before && before->step + 1 == step && time > before->time)
        row.values.speed = norm(*center - before->center) / (time - before->time);
    }
    rows.push_back(row);
  }
}

}  // namespace supple::viewer
