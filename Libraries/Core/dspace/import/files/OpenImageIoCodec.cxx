// The entry of libDspaceImageCodec.
#include <dspace/import/files/OpenImageIoReader.h>
#include <dspace/import/files/OpenImageIoWriter.h>

extern "C" const dspace::ImageCodec* DspaceImageCodec() {
  static const dspace::ImageCodec codec = {dspace::ReadWithOpenImageIo,
                                           dspace::WriteWithOpenImageIo};
  return &codec;
}
