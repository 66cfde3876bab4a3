// What long work calls now and then.
#ifndef DSPACE_SESSION_CANCEL_CHECK_H
#define DSPACE_SESSION_CANCEL_CHECK_H

#include <functional>

namespace dspace::session {

// Called at least once for each row or page. What it throws ends the work, which leaves nothing
// behind.
using CancelCheck = std::function<void()>;

} // namespace dspace::session

#endif
