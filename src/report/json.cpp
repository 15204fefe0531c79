#include "report/json.h"

namespace cagewright {

nlohmann::json json_of(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

nlohmann::json json_of(const OrientedBox& box) {
  return {{"center", json_of(box.center)},
          {"axes",
           {json_of(Vec3(box.axes.col(0))), json_of(Vec3(box.axes.col(1))),
            json_of(Vec3(box.axes.col(2)))}},
          {"half_lengths", json_of(box.half)},
          {"volume", box.volume()}};
}

std::string text_of(const nlohmann::json& json, int indent) {
  return json.dump(indent, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

} // namespace cagewright
