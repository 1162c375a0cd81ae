# Writes what a PsychoPy experiment (Builder's code) writes: psychopy.data.ExperimentHandler and TrialHandler2.
from psychopy import data, __version__
import sys, random
ratings = {'01': (2.5, 7), '02': (3, 9), '03': (1, 8.25)}
for who, (ten, hundred) in ratings.items():
    info = {'participant': who, 'session': '001', 'date': '2026-11-22_10h00.00.000', 'expName': 'rating, pictures', 'psychopyVersion': __version__, 'frameRate': 60.0021}
    exp = data.ExperimentHandler(name='rating, pictures', version='', extraInfo=info, runtimeInfo=None, savePickle=False, saveWideText=True, dataFileName=f'{who}_rating')
    exp.addData('instructions.started', 0.61); exp.addData('key_resp.keys', 'space'); exp.nextEntry()
    practice = data.TrialHandler2(nReps=1, method='sequential', trialList=[{'image': 'img/a10.png', 'rays': '10K'}], name='practice', seed=1)
    exp.addLoop(practice)
    for t in practice:
        practice.addData('slider.response', 5.0); practice.addData('slider.rt', 1.83); exp.nextEntry()
    trials = data.TrialHandler2(nReps=2, method='random', trialList=[{'image': 'img/a10.png', 'rays': '10K', 'notes': 'low, "grainy"'}, {'image': 'img/a100.png', 'rays': '100K', 'notes': ''}], name='trials', seed=int(who))
    exp.addLoop(trials)
    for t in trials:
        value = ten if t['rays'] == '10K' else hundred
        # The two showings average to the rating.
        trials.addData('slider.response', value + (0.5 if trials.thisRepN == 0 else -0.5)); trials.addData('slider.rt', 1.2); trials.addData('trial.started', 3.5)
        exp.nextEntry()
    exp.addData('thanks.started', 90.1)
    exp.nextEntry()
    exp.saveAsWideText(f'{who}_rating.csv', delim='auto')
    exp.abort()
