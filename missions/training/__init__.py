"""The learned predictor of section 4.2.1: training data from study runs, and nets fitted to it with torch.

situations  what is learned from: one agent with two or three targets until it loses one
rows        a situation tick by tick: inputs, the teacher's time, and what eq. 10 says
fit         the net of the paper, fitted with torch
weights     the small file that carries a net to the rules; reading it needs no torch
figure7     the net as a picture
train       all of it in order: `swarm train`
"""
