#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "session/program/program.hpp"
#include "supple/scene.hpp"

namespace supple::viewer {

/// The fields of the user (`View::set_field`). The program sets them, and the session reads them, in any
/// threads.
class UserFields {
 public:
  void set(const Scene& scene, ObjectId object, std::string_view name, std::span<const double> numbers,
           bool is_vector, std::optional<FieldElement> element);
  std::vector<UserField> list() const;
  /// Null when the object has no values.
  std::shared_ptr<const std::vector<double>> values(std::string_view name, ObjectId object) const;

 private:
  using Values = std::shared_ptr<const std::vector<double>>;
  struct Field {
    UserField form;
    std::vector<std::pair<ObjectId, Values>> values;
  };

  const Field* find(std::string_view name) const;
  void check_form(const Scene& scene, ObjectId object, const UserField& form) const;

  mutable std::mutex mutex_;
  std::vector<Field> fields_;  // in the order in which they were set first
};

}  // namespace supple::viewer
