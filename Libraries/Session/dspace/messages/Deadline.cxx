#include <dspace/messages/Deadline.h>

#include <dspace/Checks.h>

namespace dspace::session {

void Deadline::Throw() const {
  throw Error(Error::Kind::DeadlineExceeded, this->Command_,
              "it takes longer than its deadline of " + NumberText(*this->Seconds_) +
                  " s; accepted: a later deadline, " + this->Fewer_ + ", or none");
}

} // namespace dspace::session
