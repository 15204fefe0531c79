/// \file
/// Large things are given back beside the GUI thread: half a gigabyte takes a tenth of a second.
#pragma once

#include <QCoreApplication>
#include <QThreadPool>

#include <memory>
#include <utility>

namespace cagewright::app {

/// The same thing, whose end comes on a thread of the pool, wherever the last who shares it is.
template <class T> std::shared_ptr<T> freed_elsewhere(std::shared_ptr<T> thing) {
  T* const raw = thing.get();
  return std::shared_ptr<T>(raw, [thing = std::move(thing)](T*) mutable {
    if (QCoreApplication::instance() != nullptr) {
      QThreadPool::globalInstance()->start([last = std::move(thing)]() mutable { last.reset(); });
    } else {
      thing.reset();
    }
  });
}

} // namespace cagewright::app
