// A callback with which long work can be cancelled.
#ifndef DSPACE_SESSION_CANCEL_CHECK_H
#define DSPACE_SESSION_CANCEL_CHECK_H

#include <functional>

namespace dspace::session {

// Called at least once for each row or page. An exception cancels the work, which then removes its
// partial result.
using CancelCheck = std::function<void()>;

} // namespace dspace::session

#endif
