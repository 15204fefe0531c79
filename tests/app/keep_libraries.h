/// \file
/// Libraries stay loaded in sanitizer builds: a driver that is unloaded takes its name with it, by
/// which leaks.txt knows what it keeps. Include it in the file with main().
#pragma once

#ifdef __SANITIZE_ADDRESS__
extern "C" int dlclose(void* /*library*/) noexcept {
  return 0;
}
#endif
