// The folder of the data that ship, for tests.
#ifndef DSPACE_TEST_SHIPPED_FILES_H
#define DSPACE_TEST_SHIPPED_FILES_H

#include <cstdlib>

#include <QString>

inline QString ShippedData() {
  return QString::fromUtf8(std::getenv("DSPACE_SHIPPED_DATA"));
}

#endif
