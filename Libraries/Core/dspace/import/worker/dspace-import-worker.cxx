// Started by ImportWorker, never by people: its socket is on descriptor 3.
#include <dspace/import/files/ImageReader.h>
#include <dspace/import/files/ModelReader.h>
#include <dspace/import/vrml/VrmlCoin.h>
#include <dspace/import/worker/WorkerProcess.h>

int main() {
  return dspace::RunImportWorker({dspace::ReadModel, dspace::ReadImage, dspace::ReadUrdf},
                                 [] { const dspace::CoinSession coin; });
}
