/// \file
/// Budgets, and what is said where they are not kept. Internal to this module.
#pragma once

#include "improve/improve.h"
#include <cagewright/cage/generated_cage.h>

#include <algorithm>
#include <string>
#include <utility>

namespace cagewright {

/// How many vertices the options allow: a closed surface has half as many as triangles, and two
/// more. 0: any number.
inline int vertices_allowed(const GenerateOptions& options) {
  const int vertices = vertex_limit(options);
  return vertices > 0 ? vertices : options.faces > 0 ? options.faces / 2 + 2 : 0;
}

inline void drop(GeneratedCage& cage, Reason reason) {
  std::erase_if(cage.remarks, [&](const Remark& remark) { return remark.reason == reason; });
}

/// In place of what was said for the same reason.
inline void add(GeneratedCage& cage, Remark remark) {
  drop(cage, remark.reason);
  cage.remarks.push_back(std::move(remark));
}

/// Whether the budget, and the gap if one was asked for, were kept.
inline bool is_within_budget(const GeneratedCage& cage) {
  return cage.find(Reason::budget_not_reached) == nullptr &&
         cage.find(Reason::gap_not_kept) == nullptr;
}

} // namespace cagewright
