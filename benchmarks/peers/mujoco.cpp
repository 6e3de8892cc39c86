// The chains and the arm in MuJoCo: `mj_forward` on models that `engines.py` has compiled.

#include <cstring>
#include <string>

#include <mujoco/mujoco.h>

namespace {

struct Engine {
    mjModel *model;
    mjData *data;

    explicit Engine(const char *name) {
        model = mj_loadModel((std::string(MODELS) + "/" + name + ".mjb").c_str(), nullptr);
        data = mj_makeData(model);
    }

    void value(const double *x, const double *u, double *result) {
        const auto size = model->nv * sizeof(double);
        std::memcpy(data->qpos, x, size);
        std::memcpy(data->qvel, x + model->nv, size);
        std::memcpy(data->qfrc_applied, u, size);
        mj_forward(model, data);
        std::memcpy(result, x + model->nv, size);
        std::memcpy(result + model->nv, data->qacc, size);
    }
};

}  // namespace

#define CHAIN(name)                                                                                 \
    extern "C" void mujoco_##name##_value_forward(const double *x, const double *u, double *result) { \
        static Engine engine(#name);                                                                \
        engine.value(x, u, result);                                                                 \
    }

CHAIN(chain8)
CHAIN(chain16)
CHAIN(chain64)
CHAIN(arm)
