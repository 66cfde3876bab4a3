// GDAL's reference systems between threads. Not a public header.
#ifndef DSPACE_TERRAIN_OGRLOCK_H
#define DSPACE_TERRAIN_OGRLOCK_H

#include <mutex>

namespace dspace {

// To be held while Crs::Ogr() is handed to GDAL: a reference system changes inside when it is only
// read, and threads that use the same one at once find it broken.
inline std::mutex& OgrMutex() {
  static std::mutex mutex;
  return mutex;
}

} // namespace dspace

#endif
