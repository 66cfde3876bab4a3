// Why nobody answers.
#ifndef DSPACE_SESSION_LINK_DIAGNOSIS_H
#define DSPACE_SESSION_LINK_DIAGNOSIS_H

#include <string>

namespace dspace::session {

// What a plain connection to an address (of which LinkAddress::Parse takes in the text) tells of
// why no server has answered there, and what is accepted, for an error's end; takes up to a second.
// encrypted: certificates were used. A host that has only a name is not looked up.
std::string DiagnoseConnection(const std::string& address, bool encrypted);

} // namespace dspace::session

#endif
