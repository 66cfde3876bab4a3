#include <dspace/render/GraphicsContext.h>

namespace dspace {
namespace {

thread_local GraphicsContext* latest = nullptr;

} // namespace

GraphicsContext::~GraphicsContext() {
  if (latest == this) {
    latest = nullptr;
  }
}

GraphicsContext* GraphicsContext::Latest() {
  return latest;
}

void GraphicsContext::Made() {
  latest = this;
}

} // namespace dspace
