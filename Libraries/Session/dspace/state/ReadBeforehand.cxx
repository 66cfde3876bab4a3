#include <dspace/state/ReadBeforehand.h>

#include <dspace/state/TerrainObject.h>

namespace dspace::session {
namespace {

thread_local ReadBeforehand* ReadForThisThread = nullptr;

} // namespace

ReadBeforehand::ReadBeforehand() = default;
ReadBeforehand::~ReadBeforehand() = default;

ReadBeforehand* ReadBeforehand::Current() {
  return ReadForThisThread;
}

ReadBeforehand::Scope::Scope(ReadBeforehand* read) : Outer_(ReadForThisThread) {
  ReadForThisThread = read;
}

ReadBeforehand::Scope::~Scope() {
  ReadForThisThread = this->Outer_;
}

} // namespace dspace::session
