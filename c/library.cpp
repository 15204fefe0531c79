#include "calls.h"

#include <cagewright/version.h>

#include <cstdlib>

using namespace cagewright;

int cw_abi_version(void) {
  return CW_ABI_VERSION;
}

const char* cw_version(void) {
  return CAGEWRIGHT_VERSION;
}

const char* cw_features(void) {
  return CAGEWRIGHT_FEATURES;
}

const char* cw_licence(void) {
  return CAGEWRIGHT_LICENCE;
}

void cw_free(char* text) {
  std::free(text);
}

const char* cw_name_of_code(cw_code code) {
  switch (code) {
  case CW_OK:
    return "ok";
  case CW_CANNOT_OPEN:
    return "cannot_open";
  case CW_CANNOT_WRITE:
    return "cannot_write";
  case CW_MALFORMED:
    return "malformed";
  case CW_UNSUPPORTED:
    return "unsupported";
  case CW_TOO_LARGE:
    return "too_large";
  case CW_UNFIT_MODEL:
    return "unfit_model";
  case CW_INVALID_CAGE:
    return "invalid_cage";
  case CW_INVALID_OPTION:
    return "invalid_option";
  case CW_NO_VALID_CAGE:
    return "no_valid_cage";
  case CW_MISMATCH:
    return "mismatch";
  case CW_NOT_AVAILABLE:
    return "not_available";
  case CW_CANCELLED:
    return "cancelled";
  case CW_INTERNAL:
    return "internal";
  }
  return "unknown";
}

cw_code cw_error_code(const cw_error* error) {
  return error != nullptr ? error->code : CW_OK;
}

const char* cw_error_message(const cw_error* error) {
  return error != nullptr ? error->message.c_str() : "";
}

void cw_error_free(cw_error* error) {
  delete error;
}

cw_stop* cw_stop_new(void) {
  try {
    return new cw_stop;
  } catch (...) {
    return nullptr;
  }
}

void cw_stop_request(cw_stop* stop) {
  if (stop != nullptr) {
    stop->flag.request_stop();
  }
}

void cw_stop_free(cw_stop* stop) {
  delete stop;
}
