// Diagnosis of a failed connection.
#ifndef DSPACE_SESSION_LINK_DIAGNOSIS_H
#define DSPACE_SESSION_LINK_DIAGNOSIS_H

#include <string>

namespace dspace::session {

// Opens a plain socket to the address (valid for LinkAddress::Parse) and returns the reason why the
// server does not respond, and what is accepted, as the end of an error message. Takes up to 1 s.
// `encrypted`: the client used certificates. Host names are not resolved.
std::string DiagnoseConnection(const std::string& address, bool encrypted);

} // namespace dspace::session

#endif
