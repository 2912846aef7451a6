"""Run by module.sh in a folder with body.ply, motion.csv, data.csv and hidden.csv."""

import gc
import math
import os
import pathlib
import signal
import subprocess
import threading
import time
import unittest

import numpy as np

import hapsim


class Arrays(unittest.TestCase):
    def test_views_are_no_copies(self):
        data = hapsim.Recording.read("data.csv")
        self.assertEqual(data.columns, "press t x y z ux uy uz fx fy fz".split())
        self.assertEqual(data.f.shape, (len(data), 3))
        self.assertTrue(np.shares_memory(data.f, data["fz"]))
        self.assertTrue(np.shares_memory(data.u, data.u))
        self.assertEqual(data.press.dtype, np.int32)
        np.testing.assert_array_equal(data.f[:, 2], data["fz"])
        data["fz"][3] = 7.5
        self.assertEqual(data.f[3, 2], 7.5)
        data.write("changed.csv")
        self.assertEqual(hapsim.Recording.read("changed.csv")["fz"][3], 7.5)

    def test_a_view_outlives_its_owner(self):
        z = hapsim.Recording.read("data.csv")["z"]
        nodes = hapsim.Body.read("body.ply").nodes
        gc.collect()
        self.assertTrue((z == 0.04).all())
        np.testing.assert_allclose(nodes.max(axis=0), [0.06, 0.05, 0.04], atol=1e-9)

    def test_a_body(self):
        body = hapsim.Body.read(pathlib.Path("body.ply"))
        self.assertEqual(body.tets.shape[1], 4)
        self.assertTrue(0 <= body.tets.min() and body.tets.max() < len(body.nodes))
        a, b, c, d = (body.nodes[body.tets[:, k]] for k in range(4))
        volume = np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a).sum() / 6
        self.assertAlmostEqual(volume, 0.06 * 0.05 * 0.04)
        self.assertTrue((body.nodes[body.fixed == 1][:, 2] == 0).all())
        with self.assertRaises(ValueError):
            body.nodes[0, 0] = 1

    def test_a_recording_of_arrays(self):
        n = 20
        depth = np.linspace(0, 0.001, n)
        motion = hapsim.Recording(
            {"press": np.ones(n), "t": np.arange(n) / 10, "x": np.full(n, 0.03), "y": np.full(n, 0.025),
             "z": np.full(n, 0.04), "ux": np.zeros(n), "uy": np.zeros(n), "uz": -depth},
            {"tool_radius": 0.004})
        self.assertEqual(motion.metadata, {"tool_radius": "0.004"})
        np.testing.assert_array_equal(motion["uz"], -depth)  # to the last digit
        with self.assertRaises(hapsim.UsageError):
            motion["fz"]
        motion.write("made.csv")
        self.assertEqual(hapsim.Recording.read("made.csv", forces=False).metadata["tool_radius"], "0.004")
        with self.assertRaisesRegex(hapsim.BadInputError, "one number of each column a row"):
            hapsim.Recording({"press": [1, 1], "x": [0]})
        with self.assertRaisesRegex(hapsim.BadInputError, "millimetres"):
            hapsim.Recording({"press": [1], "x": [30], "y": [25], "z": [40], "ux": [0], "uy": [0], "uz": [-1]})


class Models(unittest.TestCase):
    def test_values(self):
        model = hapsim.Model.read("hidden.csv")
        self.assertEqual(model.effects, ["elastic", "viscoelastic"])
        self.assertEqual(model["viscoelastic.tau1"], 0.3)
        model["elastic.E"] = 15000
        self.assertEqual([p["value"] for p in model.parameters if p["parameter"] == "E"], [15000])
        self.assertEqual(hapsim.Model.parse(model.text)["elastic.E"], 15000)
        other = model.copy()
        other["elastic.E"] = 1e4
        self.assertEqual(model["elastic.E"], 15000)
        with self.assertRaises(KeyError):
            model["elastic.E[1]"]
        with self.assertRaisesRegex(hapsim.UsageError, "out of bounds"):
            model["elastic.nu"] = 0.7


class Errors(unittest.TestCase):
    def tool_says(self, *command):
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        tool, words = done.stderr.strip().split(": ", 1)
        self.assertEqual(tool, command[0])
        return done.returncode, words

    def test_as_the_tools_have_them(self):
        body, data = hapsim.Body.read("body.ply"), hapsim.Recording.read("data.csv")
        model = hapsim.Model.read("hidden.csv")
        identify = ["hs-identify", "data.csv", "--body", "body.ply", "-o", "none.csv"]
        cases = [
            (hapsim.IoError, lambda: hapsim.Model.read("nowhere.csv"),
             ["hs-simulate", "data.csv", "--body", "body.ply", "--model", "nowhere.csv"]),
            (hapsim.BadInputError, lambda: hapsim.Recording.read("motion.csv"),
             ["hs-identify", "motion.csv", "--body", "body.ply", "-o", "none.csv"]),
            (hapsim.UsageError, lambda: hapsim.identify(data, body, fold=3), identify + ["--fold", "3"]),
            (hapsim.UsageError, lambda: hapsim.identify(data, body, add="viscoelatic"),
             identify + ["--add", "viscoelatic"]),
            (hapsim.UsageError, lambda: hapsim.identify(data, body, tool_radius="4kg"),
             identify + ["--tool-radius", "4kg"]),
            (hapsim.UsageError, lambda: hapsim.identify(data, body, fix=["nu=45"]), identify + ["--fix", "nu=45"]),
            (hapsim.UsageError, lambda: hapsim.identify(data, [body, body, body]),
             identify + ["--body", "body.ply", "--body", "body.ply"]),
            (hapsim.UsageError, lambda: hapsim.identify(data, body, profile=True, robust="huber"),
             identify + ["--profile", "--robust", "huber"]),
            (hapsim.UsageError, lambda: hapsim.identify(data, body, constrain=["E >= 9 kPa", "E2 = E"]),
             identify + ["--constrain", "E >= 9 kPa", "--constrain", "E2 = E"]),
            (hapsim.UsageError, lambda: hapsim.diagnose(data, body, model, noise=1000),
             ["hs-diagnose", "data.csv", "--body", "body.ply", "--model", "hidden.csv", "--noise", "1000"]),
        ]
        # Bounds and choices, each as the tool's.
        for flag, value in [("folds", -1), ("folds", 1001), ("starts", 0), ("starts", 100001), ("seed", -1),
                            ("robust", "l1"), ("threads", 2000), ("rim-edge", 0.6), ("floor", 2), ("noise", 0),
                            ("tool-radius", 2)]:
            cases.append((hapsim.UsageError, lambda f=flag, v=value: hapsim.identify(data, body, **{f.replace("-", "_"): v}),
                          identify + [f"--{flag}={value}"]))
        for flag, value in [("folds", 1), ("flips", 98), ("flips", 1000001), ("seed", -1)]:
            cases.append((hapsim.UsageError, lambda f=flag, v=value: hapsim.diagnose(data, body, model, **{f: v}),
                          ["hs-diagnose", "data.csv", "--body", "body.ply", "--model", "hidden.csv", f"--{flag}={value}"]))
        for flag, value in [("add-noise", -1), ("seed", -1)]:
            cases.append((hapsim.UsageError,
                          lambda f=flag, v=value: hapsim.simulate(data, body, model, **{f.replace("-", "_"): v}),
                          ["hs-simulate", "data.csv", "--body", "body.ply", "--model", "hidden.csv", f"--{flag}={value}"]))
        for kind, call, command in cases:
            with self.subTest(command=" ".join(command)):
                code, words = self.tool_says(*command)
                with self.assertRaises(kind) as caught:
                    call()
                self.assertEqual(str(caught.exception), words)
                self.assertEqual(caught.exception.code, code)
                self.assertIsInstance(caught.exception, hapsim.Error)

    def test_what_is_no_body(self):
        with self.assertRaises(TypeError):
            hapsim.identify(hapsim.Recording.read("data.csv"), "body.ply")


class Work(unittest.TestCase):
    def setUp(self):
        self.body, self.data = hapsim.Body.read("body.ply"), hapsim.Recording.read("data.csv")

    def test_what_is_said(self):
        said = []
        model = hapsim.identify(self.data, self.body, fix="nu=0.4", folds=0, noise=0.05, say=said.append)
        self.assertEqual(len(said), 1)
        self.assertIn("noise", said[0])
        self.assertEqual(model.summary["tool"], "hs-identify")
        self.assertTrue(math.isclose(model["elastic.E"], 14000, rel_tol=0.3))

        def refuse(words):
            raise RuntimeError(words)
        with self.assertRaisesRegex(RuntimeError, "noise"):
            hapsim.identify(self.data, self.body, fix="nu=0.4", folds=0, noise=0.05, say=refuse)

    def test_constraints(self):
        model = hapsim.identify(self.data, self.body, folds=0, constrain=["E <= 9 kPa", "nu >= 0.2"])
        self.assertTrue(math.isclose(model["elastic.E"], 9000, rel_tol=1e-9))
        self.assertEqual(model.metadata["binding"], "E <= 9 kPa")
        self.assertGreater(model.summary["values"]["cost of E <= 9 kPa"]["value"], 0)
        named = hapsim.identify(self.data, self.body, folds=0, constrain="E(gel) <= 9 kPa", region_names="gel")
        self.assertEqual(named["elastic.E"], model["elastic.E"])
        self.assertEqual(named.metadata["region_names"], "gel")

    def test_a_diagnosis(self):
        model = hapsim.identify(self.data, self.body, fix="nu=0.4", folds=0)
        diagnosis = hapsim.diagnose(self.data, self.body, model, flips=99)
        self.assertEqual(diagnosis["verdict"], diagnosis.summary["verdict"])
        self.assertIn("viscoelastic", diagnosis.text)
        plan = hapsim.plan(diagnosis, presses=1)
        self.assertNotIn("fz", plan.columns)
        forces = hapsim.simulate(plan, self.body, model)
        self.assertEqual(len(forces), len(plan))
        comparison = hapsim.compare(self.data, hapsim.simulate(self.data, self.body, model))
        rest = comparison.residuals
        np.testing.assert_array_equal(rest["fz"] - rest["sz"], rest["rz"])
        self.assertAlmostEqual(comparison["rmse"], np.sqrt(np.mean([rest[c] ** 2 for c in ("rx", "ry", "rz")])))

    def test_an_interrupt_ends_it(self):
        timer = threading.Timer(0.2, os.kill, (os.getpid(), signal.SIGINT))
        timer.start()
        start = time.monotonic()
        with self.assertRaises(KeyboardInterrupt):
            hapsim.identify(self.data, self.body, fix="nu=0.4", starts=100000)
        self.assertLess(time.monotonic() - start, 60)

    def test_threads_work_beside_each_other(self):
        model = hapsim.Model.read("hidden.csv")
        forces = [None] * 2

        def work(k):
            forces[k] = hapsim.simulate(self.data, self.body, model).f.copy()
        threads = [threading.Thread(target=work, args=(k,)) for k in range(2)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        np.testing.assert_array_equal(*forces)


class Live(unittest.TestCase):
    def test_steps(self):
        body, model = hapsim.Body.read("body.ply"), hapsim.Model.read("hidden.csv")
        prepared = hapsim.prepare(body, model, tool_radius="4mm", accuracy=0.3)
        t = np.arange(300) * 0.001
        tips = np.column_stack([np.full(300, 0.03), np.full(300, 0.025), 0.0405 - 0.01 * t])
        together = hapsim.Live(prepared).run(t, tips)
        live = hapsim.Live(prepared)
        one_by_one = np.array([live.step(tip, when) for when, tip in zip(t, tips)])
        np.testing.assert_array_equal(together, one_by_one)
        pair = [hapsim.Live(prepared), hapsim.Live(prepared)]
        beside = [hapsim.Live.step_all(pair, when, [tip, tip + (0.01, 0, 0)]) for when, tip in zip(t, tips)]
        np.testing.assert_array_equal([both[0] for both in beside], one_by_one)
        self.assertGreater(beside[-1][1][2], 0)
        with self.assertRaisesRegex(hapsim.BadInputError, "there are 2 tools"):
            hapsim.Live.step_all(pair, 0, [tips[0]])
        feel = live.feel
        self.assertTrue(feel.contact and feel.press == 1)
        np.testing.assert_array_equal(feel.force, one_by_one[-1])
        self.assertGreater(live.step((0.03, 0.025, 0.039))[2], 0)
        live = hapsim.Live(body, model, tool_radius=0.004, accuracy=0.3)
        self.assertEqual(live.step([0.03, 0.025, 0.05]).tolist(), [0, 0, 0])
        hand = hapsim.Live(prepared, hand=True, max_force=0.1)
        self.assertLessEqual(hand.run(t, tips).max(), 0.1 + 1e-9)
        with self.assertRaisesRegex(hapsim.BadInputError, "three numbers"):
            live.run(t, tips[:, :2])
        with self.assertRaises((TypeError, RuntimeError)):
            live.step("here")


if __name__ == "__main__":
    unittest.main()
