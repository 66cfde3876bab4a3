#include <dspace/posts/PostSource.h>

#include <dspace/posts/PostProbe.h>

namespace dspace {

std::unique_ptr<PostProbe> PostSource::MakeProbe() const {
  return nullptr;
}

} // namespace dspace
