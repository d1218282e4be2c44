# ---
# jupyter:
#   jupytext:
#     text_representation:
#       extension: .py
#       format_name: percent
# ---

# %% [markdown]
# # Plug in a regressor
#
# `fit_3dmm` takes any callable `(img, landmarks) -> Coefficients`: a network, a table, a function. Its answer is
# where the fit starts, or, with `refine=False`, the answer itself.

# %%
import numpy as np

import toongeo as tg
from toongeo.model import data_path

portrait = data_path("examples/portraits/moustache_man.png")
img, landmarks = tg.read_image(portrait), tg.read_landmarks(portrait.with_suffix(".pts"))
model = tg.default_model()

# %% [markdown]
# The one that comes along is ridge regression, trained on synthetic faces of the model within seconds.

# %%
ridge = tg.train_ridge_regressor(model, np.random.default_rng(0), n=500)
for refine in (False, True):
    fit = tg.fit_3dmm(img, landmarks, regressor=ridge, refine=refine)
    print(f"ridge, refine={refine}: inner landmarks off by {fit.report.rms_percent:.2f} % of the outer-eye distance")


# %% [markdown]
# A network of your own goes behind a function or a class; toongeo need not know its library. With torch:
#
# ```python
# class Network:
#     def __init__(self, module):
#         self.module = module.eval()
#
#     def __call__(self, img, landmarks):
#         with torch.inference_mode():
#             out = self.module(torch.from_numpy(img).permute(2, 0, 1)[None] / 255.0)[0].numpy()
#         return tg.Coefficients(identity=out[:81], expression=out[81:145])
# ```
#
# Any part may be left out. This one knows only that the mouth of this picture is a smile:


# %%
def smiling(img, landmarks):
    expression = np.zeros(len(model.expression))
    for side in ("Left", "Right"):
        expression[model.expression_index(f"mouthSmile{side}")] = 0.5
    return tg.Coefficients(expression=expression)


fit = tg.fit_3dmm(img, landmarks, regressor=smiling, refine=False)
smile = fit.expression_weights()["mouthSmileLeft"]
print(f"smiling, refine=False: smile {smile:.2f}, yaw {fit.camera.yaw:.1f} degrees found for it")
